cimport cython

@cython.final
cdef class JointExtremes:
    cdef const double[:] speeds
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] per_speed
    cdef const double[:] torques
    cdef const Py_ssize_t[::1] servos
    cdef const double[::1] per_torque
    cdef readonly Py_ssize_t steps, any_held
    cdef readonly double[::1] high, low
    cdef Py_ssize_t[::1] over
    cdef readonly Py_ssize_t[::1] longest, held
    cpdef int step(self) except -1
