cimport cython
from ..base cimport pointers as memory
from ..base cimport fused_in_c as fused
from ..mechanics cimport rotations
from ..base cimport vectors

cdef double _NONE

@cython.final
cdef class SoleAdmittance:
    cdef double period, share, turn_gain
    cdef public double back
    cdef double keep, largest_turn, largest_lift
    cdef readonly double roll, pitch, shift
    cdef bint stands
    cdef double fz, tx, ty
    cpdef void fade(self) noexcept
    cpdef bint acts(self) noexcept
    cpdef double turn(self, measured, wanted) except? -1.0
    cpdef void lift(self, double rate) noexcept
    cdef double _moved(self, double value, double rate, double largest) noexcept

cpdef object turned(level, double x, double y)
cpdef object risen(position, center, double roll, double pitch, double shift)
cpdef tuple pressed(wrench, level, position, center)
