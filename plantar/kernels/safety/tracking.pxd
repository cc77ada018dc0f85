cimport cython
from ..base cimport pointers as memory

from libc cimport math

cdef double _STUCK

@cython.final
cdef class TrackingCheck:
    cdef int joints, pairs, confirmed, settled, walks
    cdef Py_ssize_t ticks
    cdef double most, share, least_standing, least_first, least, far
    cdef readonly int count, noticed_count
    cdef readonly object noticed
    cdef object before, angles, over, beyond, calm, largest, recent
    cpdef void begin_support(self) noexcept
    cpdef int end_support(self) except -1
    @cython.locals(i=int)
    cdef int _learn(self) except -1
    @cython.locals(
        n=int, i=int, pair=int, moves=bint, anew=bint, stuck=bint, error=double, usual=double, allowed=double, limit=double,
        least=double, far=double, q=cython.p_double, c=cython.p_double
    )
    cpdef int update(self, measured, commanded) except -1
