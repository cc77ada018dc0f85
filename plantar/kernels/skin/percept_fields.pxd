cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors
from .sole cimport SoleKernel

cdef double _INFINITE

cdef class PerceptFields:
    cdef readonly object layout, reading, force_threshold, options, _given_active, _stuck
    cdef SoleKernel _kernel
    cdef object _summed
    cdef tuple _found
    cdef bint _compared
    cdef _fill(self, kernel, layout, reading, force_threshold, active, stuck, options, bint compared)
    @cython.locals(vertical=double)
    cpdef _fill_summed(self, layout, reading, usual, loads)
    cpdef _active_above(self)
    cpdef _loads(self)
    cpdef _wrench(self)
    cpdef _cop(self)
    cpdef _centroid(self)
    cpdef tuple _hull(self)

@cython.locals(kernel=SoleKernel, percept=PerceptFields)
cpdef unsaturated(kind, layout, reading)

cdef double _LARGEST

cdef class ReadingFields:
    cdef readonly object time, force, proximity, temperature, acceleration
    cpdef _take_over(self, time, force, proximity)
    cdef _fill(self, time, force, proximity, temperature, acceleration)
