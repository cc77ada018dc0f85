# C types of joint_extremes.py. Without a compiler this file is not read.
cimport cython


@cython.final
cdef class JointExtremes:
    cdef const double[:] speeds
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] per_speed
    cdef const double[:] torques
    cdef const Py_ssize_t[::1] servos
    cdef const double[::1] per_torque
    cdef readonly Py_ssize_t steps
    cdef readonly Py_ssize_t any_held
    cdef readonly double[::1] high
    cdef readonly double[::1] low
    cdef Py_ssize_t[::1] over
    cdef readonly Py_ssize_t[::1] longest
    cdef readonly Py_ssize_t[::1] held
    cdef Py_ssize_t[::1] since
    cdef readonly list stays

    @cython.locals(i=Py_ssize_t, speed=double, share=double, any_held=bint)
    cpdef int step(self) except -1

    @cython.locals(i=Py_ssize_t, lasting=list)
    cpdef list all_stays(self)
