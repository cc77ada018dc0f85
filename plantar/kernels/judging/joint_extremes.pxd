# C types of joint_extremes.py. Without a compiler this file is not read.
cimport cython


@cython.final
cdef class JointExtremes:
    cdef const double[:] speeds
    cdef const Py_ssize_t[::1] places
    cdef const double[:] torques
    cdef const Py_ssize_t[::1] servos
    cdef const double[::1] per_torque
    cdef readonly double[::1] high
    cdef readonly double[::1] low
    cdef readonly double[::1] shares

    @cython.locals(i=Py_ssize_t, speed=double)
    cpdef void extend(self) noexcept

    @cython.locals(i=Py_ssize_t, share=double, at_limit=bint)
    cpdef bint tick(self) noexcept
