cimport cython
from ..base cimport pointers as memory
from .motion_load cimport MotionLoad
from .static_load cimport StaticLoad

@cython.final
cdef class CarriedMotion:
    cdef object place
    cdef StaticLoad static
    cdef tuple levers
    cdef MotionLoad motion
    cdef object turn, fall
    cdef double weight
    @cython.locals(share=double)
    cpdef int take(self, left, right, velocity, acceleration, momentum, bint whole) except -1
