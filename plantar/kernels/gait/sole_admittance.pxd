# C types of sole_admittance.py. Without a compiler this file is not read.
cimport cython
from ..base cimport pointers as memory

cdef double _NONE

@cython.final
cdef class SoleAdmittance:
    cdef double period
    cdef double share
    cdef double turn_gain
    cdef public double back
    cdef double keep
    cdef double largest_turn
    cdef double largest_lift
    cdef readonly double roll
    cdef readonly double pitch
    cdef readonly double shift
    cdef bint stands
    cdef double fz
    cdef double tx
    cdef double ty

    cpdef void fade(self) noexcept

    @cython.locals(now=cython.p_double, goal=cython.p_double, fz=double, tx=double, ty=double)
    cpdef double turn(self, measured, wanted) except? -1.0

    cpdef void lift(self, double rate) noexcept

    cdef double _moved(self, double value, double rate, double largest) noexcept
