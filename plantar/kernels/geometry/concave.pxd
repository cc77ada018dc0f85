cimport cython
from libc cimport math
from cpython cimport exc as signals
from ..base cimport work_arrays
from . cimport rectangle

@cython.final
cdef class OutlineRectangles:
    cdef bint lists
    cdef Py_ssize_t m, rings, room, many
    cdef double[::1] points, xs, ys, line, edge, trapezoid, reach, left, right, stack, ring, kept, work, corner
    cdef Py_ssize_t[::1] order, rank, first, filled, start, slab, path
    cdef double best, x1, x2, y1, y2
    cpdef int take(self, const double[:, :] points, object starts) except -1
    cpdef double largest(self, double angle, double[::1] out) except -1
    cdef int _find_ways(self, Py_ssize_t slabs) except -1
    cdef void _walk(self, Py_ssize_t start, Py_ssize_t slabs, bint exact) noexcept
    cdef bint _may_hold(self, double width, double height) noexcept
    cdef void _offer(self, double x1, double x2, double y1, double y2) noexcept
    cdef void _solve(self, Py_ssize_t i, Py_ssize_t k, double low, double high, Py_ssize_t start, Py_ssize_t end) noexcept
    cdef Py_ssize_t _cut(self, double angle) except -1
    cdef Py_ssize_t _rank(self) noexcept
    cdef void _turn(self, double angle) noexcept
    cdef void _pair_edges(self, Py_ssize_t slabs) noexcept
    cdef Py_ssize_t _octagon(
        self, Py_ssize_t i, Py_ssize_t k, double low, double high, Py_ssize_t start, Py_ssize_t end
    ) noexcept
    cdef Py_ssize_t _clip(self, Py_ssize_t n, double x1, double x2, Py_ssize_t at, double low, double high) noexcept
    cdef Py_ssize_t _keep_left(self, Py_ssize_t n, double x1, double y1, double x2, double y2) noexcept

cdef Py_ssize_t _add(double[::1] ring, Py_ssize_t n, double x, double y) noexcept
