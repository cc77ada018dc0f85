# C types of load_transfer.py. Without a compiler this file is not read.
cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors

cdef int _LEFT
cdef int _RIGHT

@cython.locals(
    goal=cython.p_double, rate=cython.p_double, lx=double, ly=double, rx=double, ry=double, x=double, y=double,
    dx=double, dy=double, apart=double, share=double, other=double, fx=double, fy=double, fz=double
)
cpdef tuple shared_load(zmp, acceleration, double mass, double gravity, left, right, int stance)

@cython.locals(place=cython.p_double, turn=cython.p_double, middle=cython.p_double, x=double, y=double)
cdef (double, double) _loaded(foot) except *
