cimport cython
from libc cimport math

@cython.locals(size=double, twice=double, ux=double, uy=double)
cpdef Py_ssize_t ends_of_flat(double[::1] ring, Py_ssize_t n) noexcept
cpdef double largest_triangle(double[::1] ring, Py_ssize_t n, double[::1] out) noexcept
cpdef double largest_circle(double[::1] ring, Py_ssize_t n, double[::1] work, double[::1] out) noexcept
cdef double _deepest(
    double[::1] work, Py_ssize_t n, double x, double start, double low, double high, double tolerance
) noexcept
