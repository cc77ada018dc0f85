# C types of inscribed.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _LARGEST
cdef double _SMALLEST

@cython.locals(size=double)
cpdef Py_ssize_t clean_ring(double[::1] ring, Py_ssize_t n) noexcept
cpdef double largest_triangle(double[::1] ring, Py_ssize_t n, double[::1] out) noexcept
@cython.locals(size=double)
cpdef double largest_parallelogram(double[::1] ring, Py_ssize_t n, double[::1] out) noexcept
cpdef double largest_circle(double[::1] ring, Py_ssize_t n, double[::1] work, double[::1] out) noexcept
cdef double _deepest(
    double[::1] work, Py_ssize_t n, double x, double start, double low, double high, double tolerance
) noexcept
