from libc cimport math

cpdef double least_box(double[::1] ring, Py_ssize_t n, double[::1] out) noexcept
cpdef double least_parallelogram(double[::1] ring, Py_ssize_t n, double[::1] work, double[::1] out) noexcept
cdef Py_ssize_t _walk(double[::1] ring, Py_ssize_t n, Py_ssize_t k, double dx, double dy) noexcept
