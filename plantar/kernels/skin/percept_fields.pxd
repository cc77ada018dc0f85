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
    cdef object _polygon
    cdef bint _fills
    cdef bint _compared
    cdef bint _has_area
    cdef double _area
    cdef double _x
    cdef double _y

    cdef _fill(self, layout, reading, force_threshold, active, stuck, options, bint fills)

    @cython.locals(kernel=SoleKernel)
    cpdef _loads(self)

    @cython.locals(kernel=SoleKernel)
    cpdef double _hull_area(self) except *

    @cython.locals(kernel=SoleKernel, area=double, x=double, y=double)
    cpdef _hull(self)

    @cython.locals(area=double, x=double, y=double)
    cdef _take(self, (double, double, double) measured)

    cpdef _hull_centroid(self)
