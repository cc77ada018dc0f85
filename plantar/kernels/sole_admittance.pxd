# C types of sole_admittance.py. Without a compiler this file is not read.
cimport cython

cdef double _NONE

@cython.final
cdef class SoleAdmittance:
    cdef double period
    cdef double share
    cdef double turn_gain
    cdef double back
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

    cpdef double turn(
        self, double fz, double tx, double ty, double wanted_fz, double wanted_tx, double wanted_ty
    ) noexcept

    cpdef void lift(self, double rate) noexcept

    cdef double _moved(self, double value, double rate, double largest) noexcept
