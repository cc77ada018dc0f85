cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..geometry cimport convex

@cython.locals(growth=double, x=double, y=double)
cpdef tuple best_zmp(pendulum, double left)
@cython.locals(rate=double, growth=double, px=double, py=double, grown=double, ux=double, uy=double)
cpdef tuple missed_by(pendulum, double left)
