cimport cython
from ..base cimport pointers as memory

@cython.final
cdef class TrackingCheck:
    cdef int joints, confirmed
    cdef double most
    cdef readonly int count
    cdef readonly object off
    cdef object before, over, calm
    @cython.locals(i=int, moves=bint, error=double)
    cpdef int update(self, measured, commanded) except -1
