cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors

cdef int _LEFT, _RIGHT
@cython.locals(share=double)
cpdef tuple shared_load(zmp, acceleration, double mass, double gravity, left, right, int stance)
cdef (double, double) _loaded(foot) except *
