# C types of percept_fields.py. Without a compiler this file is not read.
cimport cython

from ..base cimport pointers as memory
from .sole cimport SoleKernel

cdef class PerceptFields:
    cdef readonly object layout
    cdef readonly object reading
    cdef readonly object force_threshold
    cdef readonly object options
    cdef readonly object _given_active
    cdef readonly object _stuck
    cdef SoleKernel _kernel
    cdef object _summed
    cdef tuple _found
    cdef bint _compared

    cdef _fill(self, kernel, layout, reading, force_threshold, active, stuck, options, bint compared)

    @cython.locals(kernel=SoleKernel)
    cpdef _loads(self)

    @cython.locals(kernel=SoleKernel, found=tuple)
    cpdef tuple _hull(self)
