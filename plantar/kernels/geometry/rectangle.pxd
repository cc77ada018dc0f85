cimport cython
from libc cimport math

@cython.final
@cython.no_gc
cdef class _Gap:
    cdef double[::1] work
    cdef Py_ssize_t upper, tops, lower, bottoms
    cdef Py_ssize_t over, over_end, under, under_end
    cdef double first, last, size
    cdef double x, height, slope, top, bottom
    cdef double in_x, in_w
    cdef void start(self, double[::1] work, Py_ssize_t upper, Py_ssize_t tops, Py_ssize_t lower, Py_ssize_t bottoms) noexcept
    cdef Py_ssize_t edge_at(self, Py_ssize_t at, Py_ssize_t count, Py_ssize_t edge, double x) noexcept
    cdef void measure(self, double x, double w) noexcept
    @cython.locals(
        rise=double, fall=double, rise_w=double, fall_w=double, rise_height=double, fall_height=double, rise_top=double,
        fall_top=double, rise_bottom=double, fall_bottom=double, mixed=double, expected=double
    )
    cdef void find_highest(self, double w) noexcept
    cdef void keep(self, double x, double height, double top, double bottom) noexcept

@cython.final
cdef class _Widths:
    cdef double left, left_height, left_slope, right, right_height, right_slope
    cdef bint has_left, has_right
    cdef void start(self, double reach) noexcept
    cdef bint cut(self, double w, double height, double slope) noexcept
    cdef double under_left(self, double w) noexcept
    cdef double under_right(self, double w) noexcept
    cdef double next_width(self, double best) noexcept

@cython.locals(best_x=double, best_w=double, best_b=double, best_t=double)
cpdef double largest_rectangle(
    double[::1] ring, Py_ssize_t n, double angle, double floor, double[::1] work, double[::1] out
) noexcept
cpdef void write_corners(
    double[::1] out, double cosine, double sine, double x1, double x2, double y1, double y2
) noexcept
cdef Py_ssize_t _chain(
    double[::1] work, Py_ssize_t n, Py_ssize_t low, Py_ssize_t high, Py_ssize_t step, double tolerance, Py_ssize_t
    at
) noexcept
cdef double _upright(double[::1] work, Py_ssize_t i, Py_ssize_t j, double width, double tolerance) noexcept
cdef double _edge_out(double[::1] work, Py_ssize_t n, double bottom, double top, double x, double way) noexcept
