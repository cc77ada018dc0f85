cimport cython

cdef double _LARGEST, _SMALLEST, _TINY
cdef Py_ssize_t _SHORT
cdef double _INFINITE
cpdef double hull_tolerance(double largest, double extent) noexcept nogil
cdef double _product_tail(double a, double b, double product) noexcept nogil
cdef double _sum_tail(double a, double b, double total) noexcept nogil
@cython.locals(terms=double[16], pairs=double[8], size=int, m=int, product=double, tail=double, total=double)
cpdef bint turn_is_left(double ax, double ay, double bx, double by, double cx, double cy) noexcept nogil
cdef bint _is_corner(double ax, double ay, double bx, double by, double cx, double cy, double tolerance) noexcept nogil
cdef bint _is_straight(
    double ax, double ay, double bx, double by, double cx, double cy, double tolerance
) noexcept nogil
cpdef Py_ssize_t hull_ring(
    const double[:, :] points, Py_ssize_t[::1] way, Py_ssize_t forth, Py_ssize_t count, double tolerance,
    Py_ssize_t[::1] ring
) noexcept nogil
cdef bint _ring_is_straight(
    const double[:, :] points, Py_ssize_t a, Py_ssize_t b, Py_ssize_t c, double tolerance
) noexcept nogil
@cython.locals(work="Py_ssize_t[::1]", ring="Py_ssize_t[::1]")
cpdef convex_hull(const double[:, :] points)
@cython.locals(left=double, right=double, bottom=double, top=double, extent=double, largest=double)
cpdef Py_ssize_t hull_of_cloud(const double[:, :] points, Py_ssize_t[::1] order, Py_ssize_t[::1] ring) except -1
cpdef void gather(const double[:, :] points, Py_ssize_t[::1] ring, Py_ssize_t size, double[:, ::1] out) noexcept nogil
