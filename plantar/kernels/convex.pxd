# C types of convex.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _LARGEST
cdef double _SMALLEST
cdef Py_ssize_t _SHORT
cdef double _INFINITE
cdef double _NONE

cpdef double hull_tolerance(double largest, double extent) noexcept

@cython.locals(t=double, a_high=double, a_low=double, b_high=double, b_low=double)
cdef double _product_tail(double a, double b, double product) noexcept

@cython.locals(a_part=double, b_part=double)
cdef double _sum_tail(double a, double b, double total) noexcept

@cython.locals(
    terms=double[16], pairs=double[8], size=int, k=int, i=int, j=int, m=int, product=double, tail=double, total=double
)
cpdef bint turn_is_left(double ax, double ay, double bx, double by, double cx, double cy) noexcept

@cython.locals(dx=double, dy=double, lx=double, ly=double, one=double, two=double, turn=double, bound=double)
cdef bint _is_corner(
    double ax, double ay, double bx, double by, double cx, double cy, double tolerance
) noexcept

@cython.locals(dx=double, dy=double, lx=double, ly=double, one=double, two=double, limit=double)
cdef bint _is_straight(
    double ax, double ay, double bx, double by, double cx, double cy, double tolerance
) noexcept

@cython.locals(
    size=Py_ssize_t, i=Py_ssize_t, p=Py_ssize_t, q=Py_ssize_t, base=Py_ssize_t, kept=Py_ssize_t, step=Py_ssize_t,
    ax=double, ay=double, bx=double, by=double, cx=double, cy=double
)
cpdef Py_ssize_t hull_ring(
    const double[:, :] points, Py_ssize_t[::1] way, Py_ssize_t forth, Py_ssize_t count, double tolerance,
    Py_ssize_t[::1] ring
) noexcept

cdef bint _ring_is_straight(
    const double[:, :] points, Py_ssize_t a, Py_ssize_t b, Py_ssize_t c, double tolerance
) noexcept

@cython.locals(n=Py_ssize_t, size=Py_ssize_t, work="Py_ssize_t[::1]", ring="Py_ssize_t[::1]")
cpdef convex_hull(const double[:, :] points)

@cython.locals(
    count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, p=Py_ssize_t, x=double, y=double, left=double, right=double,
    bottom=double, top=double, extent=double, largest=double
)
cdef Py_ssize_t _hull_of_cloud(const double[:, :] points, Py_ssize_t[::1] order, Py_ssize_t[::1] ring) except -1

@cython.locals(i=Py_ssize_t)
cdef void _gather(const double[:, :] points, Py_ssize_t[::1] ring, Py_ssize_t size, double[:, ::1] out) noexcept

@cython.locals(
    total=double, k=Py_ssize_t, i=Py_ssize_t, x0=double, y0=double, ax=double, ay=double, bx=double, by=double
)
cpdef double area(const double[:, :] polygon) noexcept

@cython.locals(
    k=Py_ssize_t, i=Py_ssize_t, x0=double, y0=double, total=double, cx=double, cy=double, mx=double, my=double,
    size=double, ax=double, ay=double, bx=double, by=double, cross=double
)
cpdef (double, double, double) area_and_centroid(const double[:, :] polygon) noexcept

@cython.locals(
    k=Py_ssize_t, i=Py_ssize_t, total=double, turn=double, inside=bint, best=double, deepest=double, span=double,
    qx=double, qy=double, ax=double, ay=double, bx=double, by=double, lx=double, ly=double, length2=double,
    across=double, along=double, px=double, py=double, t=double, distance2=double
)
cdef (double, double, double) _nearest(const double[:, :] polygon, double x, double y) noexcept

@cython.locals(_margin=double, qx=double, qy=double)
cpdef closest_point(const double[:, :] polygon, double x, double y)

cdef void _pair(double[::1] out, double x, double y) noexcept

@cython.locals(margin=double, _qx=double, _qy=double)
cpdef double signed_margin(const double[:, :] polygon, double x, double y) noexcept

cpdef seen_from_above(const double[:, :] polygon, const double[:, :] rotation, const double[:] position)

@cython.locals(i=Py_ssize_t, x=double, y=double)
cdef void _place(
    const double[:, :] polygon, const double[:, :] rotation, const double[:] position, double[:, ::1] out
) noexcept

@cython.locals(k=Py_ssize_t, room=Py_ssize_t, size=Py_ssize_t, rings=double[:, :, ::1], lines=double[:, ::1])
cpdef inner_offset(const double[:, :] polygon, double distance)

@cython.locals(i=Py_ssize_t, ring=double[:, ::1])
cdef _shifted(double[:, :, ::1] rings, Py_ssize_t size, const double[:, :] polygon)

@cython.locals(
    k=Py_ssize_t, backwards=bint, x0=double, y0=double, reach=double, i=Py_ssize_t, j=Py_ssize_t, x=double, y=double,
    used=Py_ssize_t, ax=double, ay=double, lx=double, ly=double, length=double, size=Py_ssize_t, left=Py_ssize_t,
    low=double, high=double, middle=double
)
cdef Py_ssize_t _inner_offset(
    const double[:, :] polygon, double distance, double[:, ::1] lines, double[:, :, ::1] rings
) noexcept

@cython.locals(kept=Py_ssize_t, line=Py_ssize_t, i=Py_ssize_t, found=bint)
cdef Py_ssize_t _keep_lines(
    double[:, ::1] lines, Py_ssize_t used, double[:, :, ::1] rings, Py_ssize_t size
) noexcept

@cython.locals(
    room=Py_ssize_t, source=Py_ssize_t, line=Py_ssize_t, target=Py_ssize_t, nx=double, ny=double, level=double,
    ex=double, ey=double, tag=double, before=double, count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, cx=double,
    cy=double, here=double, t=double
)
cdef Py_ssize_t _cut(
    double[:, ::1] lines, Py_ssize_t used, double depth, double[:, :, ::1] rings, Py_ssize_t size
) noexcept
