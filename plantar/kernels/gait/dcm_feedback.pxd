cimport cython
from libc cimport math
from ..geometry cimport convex
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.final
cdef class ComAdmittance:
    cdef readonly double x, y, rate_x, rate_y
    cdef double error_x, error_y, zmp_gain, com_gain, share, period, largest
    cpdef void follow(self, double x, double y) noexcept

@cython.final
cdef class DcmFeedback:
    cdef double omega, held, press, factor, period
    cdef ComAdmittance admittance
    cdef bint after
    cdef double away_x, away_y
    @cython.locals(stiffness=double)
    cpdef tuple decide(self, vrp, planned, com, com_velocity, dcm, zmp, region, bint firm)
    cdef (double, double) _desired(
        self, const double* vrp, const double* planned, const double* dcm, region
    ) except *
    @cython.locals(share=double, size=double, offset=ComAdmittance)
    cdef (double, double) _go_along(self, const double* planned, const double* dcm, bint may) noexcept

cdef int _LEFT, _RIGHT
@cython.locals(share=double)
cpdef tuple shared_load(zmp, acceleration, double mass, double gravity, left, right, int stance)
cdef (double, double) _loaded(foot) except *
