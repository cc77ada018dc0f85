cimport cython

@cython.final
cdef class AppliedForces:
    cdef const double[:, ::1] on_bodies
    cdef double[:, ::1] known
    cdef const double[::1] on_joints, springs
    cdef const Py_ssize_t[::1] own
    cdef double least
    @cython.locals(acts=bint)
    cpdef bint sprung(self) noexcept
    cpdef bint unknown(self) noexcept
