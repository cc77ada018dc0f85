cimport cython
from ..geometry cimport clean, convex
from . cimport foundation

@cython.locals(x=double, y=double)
cpdef tuple patch_key(points, double grid)

@cython.final
cdef class PressedPatch:
    cdef readonly Py_ssize_t[::1] cells
    cdef readonly double[::1] area
    cdef readonly double[:, ::1] u, inverse, reach
    cdef readonly unsigned char[::1] carried
    cdef int turn
    cdef double cx, cy, scale
    cdef readonly double x, y
    cpdef bint spread(self, double force, double x, double y, double[::1] out) except *
    @cython.locals(nearest="double[::1]")
    cdef int _to_reach(self) except -1
    cpdef bint part(self, double force, double[::1] out) noexcept
