cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.locals(c=double, d=double, dx=double, dy=double, across=double, aside=double, over=double, roll=double, e=double,
               f=double)
cpdef object leaning_torso(com, left, right, double yaw, double reach, double lean, double rounded)
