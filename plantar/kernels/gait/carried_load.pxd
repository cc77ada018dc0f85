cimport cython

cdef double _INFINITE
@cython.locals(new=double)
cpdef void take_in(
    const double[::1] force, double forgetting, double share, double[::1] total, double[::1] mean
) noexcept
@cython.locals(around=double)
cpdef void mark_carried(
    const double[::1] mean, const Py_ssize_t[:, ::1] near, double least, double beside, unsigned char[::1] carried
) noexcept
