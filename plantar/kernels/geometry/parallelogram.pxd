cimport cython

cdef int _B_ENDS, _D_ENDS, _C_ENDS, _C_RETURNS

@cython.final
@cython.no_gc
cdef class _ChordWalk:
    cdef double[::1] ring
    cdef Py_ssize_t n, a, b, c, d, corner
    cdef double size, slack, best, side_x, side_y, other_x, other_y
    cdef double x, y, t, end, turn
    cdef double b0x, b0y, bx, by, c0x, c0y, cx, cy, d0x, d0y, dx, dy
    cdef double g0, g1, e0, e1, q1, q2
    cdef void start(self, double[::1] ring, Py_ssize_t n) noexcept
    cdef void walk_from(self, Py_ssize_t a) noexcept
    cdef Py_ssize_t farthest(self) noexcept
    cdef void read_edges(self) noexcept
    cdef Py_ssize_t vertex(self, Py_ssize_t k) noexcept
    cdef Py_ssize_t after(self, Py_ssize_t i) noexcept
    cdef double lengths(self) noexcept
    cdef void slide(self) noexcept
    cdef void read_motion(self) noexcept
    cdef int read_end(self) noexcept
    cdef bint may_hold_better(self) noexcept
    cdef void try_places(self, int event) noexcept
    cdef void try_from_d(self, double s, int event) noexcept
    cdef void try_from_c(self, double s, int event) noexcept
    cdef bint is_on(self, double wx, double wy, double ex, double ey) noexcept
    cdef void keep(self, double ux, double uy, double vx, double vy) noexcept
    cdef void step_over(self, int event) noexcept

cpdef double largest_parallelogram(double[::1] ring, Py_ssize_t n, double[::1] out) noexcept
