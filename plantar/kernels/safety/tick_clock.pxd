cimport cython
from libc cimport math

cdef double _INFINITE, _NONE, _NEAR, _FOLLOWED, _STALLED, _DRAWN, _MOST_DRAWN

@cython.final
cdef class TickClock:
    cdef double period, latest, last, offset, error
    cdef bint begun
    cdef readonly Py_ssize_t odd, late
    cdef readonly double jumped
    @cython.locals(finite=bint, expected=double, error=double, late=double, most=double, drawn=double)
    cpdef double time_of(self, double reported) except? -1.0
