# C types of concave.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from . cimport rectangle

@cython.locals(
    m=Py_ssize_t, xs=double[::1], ys=double[::1], order=Py_ssize_t[::1], rank=Py_ssize_t[::1], line=double[::1],
    lines=Py_ssize_t, slabs=Py_ssize_t, first=Py_ssize_t[::1], filled=Py_ssize_t[::1], total=Py_ssize_t,
    edge=double[::1], trapezoid=double[::1], slab=Py_ssize_t[::1], count=Py_ssize_t, stack=double[::1],
    ring=double[::1], work=double[::1], corner=double[::1], low=Py_ssize_t, high=Py_ssize_t, i=Py_ssize_t,
    j=Py_ssize_t, k=Py_ssize_t, r=Py_ssize_t, t=Py_ssize_t, p=Py_ssize_t, q=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t,
    n=Py_ssize_t, top=Py_ssize_t, start=Py_ssize_t, exact=bint, found=bint, bottom=Py_ssize_t
)
cpdef double largest_rectangle_in_outline(
    const double[::1] points, const Py_ssize_t[::1] starts, double angle, double floor, double[::1] out
) except -1

cdef Py_ssize_t _octagon(
    double xa, double xb, double xc, double xd, double low, double high, double[::1] trapezoid, Py_ssize_t start,
    Py_ssize_t end, double[::1] ring
) noexcept

cdef Py_ssize_t _add(double[::1] ring, Py_ssize_t n, double x, double y) noexcept
