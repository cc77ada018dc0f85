# C types of dcm_feedback.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..geometry cimport convex
from ..base cimport pointers as memory
from ..base cimport vectors

cdef double _SAME

@cython.final
cdef class ComAdmittance:
    cdef readonly double x
    cdef readonly double y
    cdef readonly double rate_x
    cdef readonly double rate_y
    cdef double error_x
    cdef double error_y
    cdef double zmp_gain
    cdef double com_gain
    cdef double share
    cdef double period
    cdef double largest

    @cython.locals(size=double)
    cpdef void follow(self, double x, double y) noexcept

@cython.final
cdef class DcmFeedback:
    cdef double stiffness
    cdef double factor
    cdef double integral_gain
    cdef double forgetting
    cdef double largest
    cdef double period
    cdef ComAdmittance admittance
    cdef bint yields
    cdef bint after
    cdef double integral_x
    cdef double integral_y

    @cython.locals(x=double, y=double)
    cpdef object desired(self, vrp, planned, dcm, region)

    @cython.locals(
        offset=ComAdmittance, at=cython.p_double, velocity=cython.p_double, now=cython.p_double, x=double, y=double,
        cx=double, cy=double, px=double, py=double
    )
    cpdef tuple decide(self, vrp, planned, com, com_velocity, dcm, zmp, region)

    @cython.locals(ex=double, ey=double, x=double, y=double, px=double, py=double)
    cdef (double, double) _desired(
        self, const double* vrp, const double* planned, const double* dcm, region, bint integrates
    ) except *

    @cython.locals(moved=double)
    cdef double _integrated(self, double integral, double error) noexcept
