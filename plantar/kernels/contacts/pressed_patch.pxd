# C types of pressed_patch.py. Without a compiler this file is not read.
cimport cython
from ..geometry cimport clean, convex
from . cimport foundation


@cython.locals(places=set, x=double, y=double)
cpdef tuple patch_key(points, double grid)


@cython.final
cdef class PressedPatch:
    cdef readonly Py_ssize_t[::1] cells
    cdef readonly double[::1] area
    cdef readonly double[:, ::1] u
    cdef readonly double[:, ::1] inverse
    cdef readonly double[:, ::1] reach
    cdef readonly unsigned char[::1] carried
    cdef int turn
    cdef double cx
    cdef double cy
    cdef double scale
    cdef readonly double x
    cdef readonly double y

    @cython.locals(some=bint, i=Py_ssize_t)
    cpdef bint spread(self, double force, double x, double y, double[::1] out) except *

    @cython.locals(nearest="double[::1]", _margin=double)
    cdef int _to_reach(self) except -1

    cpdef bint part(self, double force, double[::1] out) noexcept
