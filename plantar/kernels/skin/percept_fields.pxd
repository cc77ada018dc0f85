# C types of percept_fields.py. Without a compiler this file is not read.
cimport cython

from ..base cimport pointers as memory
from ..base cimport vectors
from .sole cimport SoleKernel

cdef double _INFINITE

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

    cpdef _active_above(self)

    @cython.locals(kernel=SoleKernel)
    cpdef _loads(self)

    cpdef _wrench(self)

    @cython.locals(vertical=double)
    cpdef _cop(self)

    @cython.locals(found=tuple)
    cpdef _centroid(self)

    @cython.locals(kernel=SoleKernel, found=tuple)
    cpdef tuple _hull(self)
