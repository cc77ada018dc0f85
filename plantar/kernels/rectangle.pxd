# C types of rectangle.py. Without a compiler this file is not read.
from libc cimport math

cpdef double largest_rectangle(
    double[::1] ring, Py_ssize_t n, double angle, double floor, double[::1] work, double[::1] out
) noexcept
cpdef void write_corners(
    double[::1] out, double cosine, double sine, double x1, double x2, double y1, double y2
) noexcept
cpdef double lean(double[::1] corners) noexcept
cdef Py_ssize_t _chain(
    double[::1] work, Py_ssize_t n, Py_ssize_t low, Py_ssize_t high, Py_ssize_t step, double tolerance, Py_ssize_t
    at
) noexcept

cdef double _upright(double[::1] work, Py_ssize_t i, Py_ssize_t j, double width, double tolerance) noexcept
