cimport cython

cdef double _LARGEST
cdef double _SMALLEST
cdef double _TINY
cdef Py_ssize_t _SHORT
cdef double _INFINITE

cpdef double hull_tolerance(double largest, double extent) noexcept nogil

@cython.locals(t=double, a_high=double, a_low=double, b_high=double, b_low=double)
cdef double _product_tail(double a, double b, double product) noexcept nogil

@cython.locals(a_part=double, b_part=double)
cdef double _sum_tail(double a, double b, double total) noexcept nogil

@cython.locals(
    terms=double[16], pairs=double[8], size=int, k=int, i=int, j=int, m=int, product=double, tail=double, total=double
)
cpdef bint turn_is_left(double ax, double ay, double bx, double by, double cx, double cy) noexcept nogil

@cython.locals(dx=double, dy=double, lx=double, ly=double, one=double, two=double, turn=double, bound=double)
cdef bint _is_corner(
    double ax, double ay, double bx, double by, double cx, double cy, double tolerance
) noexcept nogil

@cython.locals(dx=double, dy=double, lx=double, ly=double, one=double, two=double, limit=double)
cdef bint _is_straight(
    double ax, double ay, double bx, double by, double cx, double cy, double tolerance
) noexcept nogil

@cython.locals(
    size=Py_ssize_t, i=Py_ssize_t, p=Py_ssize_t, q=Py_ssize_t, base=Py_ssize_t, kept=Py_ssize_t, step=Py_ssize_t,
    ax=double, ay=double, bx=double, by=double, cx=double, cy=double
)
cpdef Py_ssize_t hull_ring(
    const double[:, :] points, Py_ssize_t[::1] way, Py_ssize_t forth, Py_ssize_t count, double tolerance,
    Py_ssize_t[::1] ring
) noexcept nogil

cdef bint _ring_is_straight(
    const double[:, :] points, Py_ssize_t a, Py_ssize_t b, Py_ssize_t c, double tolerance
) noexcept nogil

@cython.locals(n=Py_ssize_t, size=Py_ssize_t, work="Py_ssize_t[::1]", ring="Py_ssize_t[::1]")
cpdef convex_hull(const double[:, :] points)

@cython.locals(
    count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, p=Py_ssize_t, x=double, y=double, left=double, right=double,
    bottom=double, top=double, extent=double, largest=double, tiny=bint
)
cpdef Py_ssize_t hull_of_cloud(const double[:, :] points, Py_ssize_t[::1] order, Py_ssize_t[::1] ring) except -1

@cython.locals(i=Py_ssize_t)
cpdef void gather(const double[:, :] points, Py_ssize_t[::1] ring, Py_ssize_t size, double[:, ::1] out) noexcept nogil
