cimport cython

@cython.final
cdef class AppliedForces:
    cdef const double[:, ::1] on_bodies
    cdef double[:, ::1] known
    cdef const double[::1] on_joints
    cdef const Py_ssize_t[::1] own
    cdef double least
    cpdef bint unknown(self) noexcept
