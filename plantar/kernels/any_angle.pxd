# C types of any_angle.py. Without a compiler this file is not read.
from libc cimport math
from . cimport concave, rectangle

cdef double _QUARTER
cdef double _NEAR
cdef double _GOLDEN
cdef int _SECTIONS
cdef int _BETWEEN

cpdef double largest_rectangle_at_any_angle(
    double[::1] ring, Py_ssize_t n, const Py_ssize_t[::1] starts, Py_ssize_t samples, double[::1] work,
    double[::1] out
) except -1

cdef double _largest(
    double[::1] ring, Py_ssize_t n, const Py_ssize_t[::1] starts, double angle, double floor, double[::1] work,
    double[::1] out
) except -1
