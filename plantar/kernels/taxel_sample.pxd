# C types of taxel_sample.py. Without a compiler this file is not read.
cimport cython

cdef double _NONE

cpdef taxel_sample(
    const double[:] force, const double[:] noise, double least, double most, const Py_ssize_t[::1] dead
)

@cython.locals(i=Py_ssize_t, value=double)
cdef void _fill(
    const double[:] force, const double[:] noise, double least, double most, const Py_ssize_t[::1] dead,
    double[::1] out
) noexcept
