# C types of concave.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from cpython cimport exc as signals
from ..base cimport work_arrays
from . cimport rectangle

cdef double _INF
cdef Py_ssize_t _ASK


@cython.final
cdef class OutlineRectangles:
    cdef bint lists
    cdef Py_ssize_t m
    cdef Py_ssize_t rings
    cdef Py_ssize_t given_rings
    cdef Py_ssize_t parts
    cdef Py_ssize_t room
    cdef Py_ssize_t many
    cdef double[::1] given
    cdef double[::1] points
    cdef double[::1] xs
    cdef double[::1] ys
    cdef double[::1] line
    cdef Py_ssize_t[::1] order
    cdef Py_ssize_t[::1] rank
    cdef Py_ssize_t[::1] first
    cdef Py_ssize_t[::1] filled
    cdef Py_ssize_t[::1] given_start
    cdef Py_ssize_t[::1] start
    cdef Py_ssize_t[::1] owner
    cdef readonly Py_ssize_t[::1] part
    cdef double[::1] ring_area
    cdef readonly double[::1] part_area
    cdef double[::1] edge
    cdef double[::1] trapezoid
    cdef double[::1] reach
    cdef double[::1] left
    cdef double[::1] right
    cdef double[::1] stack
    cdef Py_ssize_t[::1] slab
    cdef Py_ssize_t[::1] path
    cdef double[::1] ring
    cdef double[::1] work
    cdef double[::1] corner
    cdef public Py_ssize_t spent
    cdef Py_ssize_t next_look
    cdef double limit
    cdef readonly bint ended
    cdef double best
    cdef bint found
    cdef double x1
    cdef double x2
    cdef double y1
    cdef double y2


    @cython.locals(
        m=Py_ssize_t, rings=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, r=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t,
        twice=double, whole=double
    )
    cpdef Py_ssize_t take(self, const double[:, :] points, object starts, bint apart) except -1

    cdef int _count(self, Py_ssize_t work) except -1
    cpdef void allow(self, double work) noexcept

    @cython.locals(
        given="double[::1]", a=Py_ssize_t, x=double, y=double, best=Py_ssize_t, k=Py_ssize_t, r=Py_ssize_t, inside=bint,
        i=Py_ssize_t, j=Py_ssize_t, share=double
    )
    cdef Py_ssize_t _around(self, Py_ssize_t hole) noexcept

    @cython.locals(chosen=Py_ssize_t, m=Py_ssize_t, rings=Py_ssize_t, r=Py_ssize_t, i=Py_ssize_t)
    cpdef double choose(self, Py_ssize_t k) noexcept

    cpdef double largest(self, double angle, double floor, double[::1] out) except -1

    @cython.locals(
        slabs=Py_ssize_t, line="double[::1]", slab="Py_ssize_t[::1]", trapezoid="double[::1]", count=Py_ssize_t,
        reach="double[::1]", left="double[::1]",
        start=Py_ssize_t, i=Py_ssize_t, exact=bint, below=double, above=double, low_right=double, high_right=double
    )
    cdef double _enumerate(self, double angle, double floor, double[::1] out) except -1

    @cython.locals(
        least=double, k=Py_ssize_t, t=Py_ssize_t, start=Py_ssize_t, far=double, bottom_y=double,
        top_y=double, wide=double
    )
    cdef int _find_ways(self, Py_ssize_t slabs, double floor) except -1

    @cython.locals(
        i=Py_ssize_t, k=Py_ssize_t, t=Py_ssize_t, top=Py_ssize_t, x=double, width=double, height=double,
        left_low=double, left_high=double, low_y=double, high_y=double, below=double, above=double, low_right=double,
        high_right=double, bottom_y=double, top_y=double
    )
    cdef void _walk(self, Py_ssize_t start, Py_ssize_t slabs, bint exact) noexcept

    cdef bint _may_hold(self, double width, double height) noexcept
    cdef void _offer(self, double x1, double x2, double y1, double y2) noexcept

    @cython.locals(n=Py_ssize_t, area=double, floor=double)
    cdef void _solve(
        self, Py_ssize_t i, Py_ssize_t k, double low, double high, Py_ssize_t start, Py_ssize_t end
    ) noexcept

    @cython.locals(
        m=Py_ssize_t, ys="double[::1]", rank="Py_ssize_t[::1]",
        line="double[::1]", first="Py_ssize_t[::1]", start="Py_ssize_t[::1]", filled="Py_ssize_t[::1]",
        edge="double[::1]", slabs=Py_ssize_t, total=Py_ssize_t, across=Py_ssize_t,
        i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, p=Py_ssize_t, r=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t,
        low=Py_ssize_t, high=Py_ssize_t, side=double, left=double, right=double, moved=Py_ssize_t
    )
    cdef Py_ssize_t _cut(self, double angle) except -1

    @cython.locals(m=Py_ssize_t, lines=Py_ssize_t, tolerance=double, k=Py_ssize_t, i=Py_ssize_t)
    cdef Py_ssize_t _rank(self) noexcept

    @cython.locals(
        m=Py_ssize_t, cosine=double, sine=double, gap=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, p=Py_ssize_t,
        key=double
    )
    cdef void _turn(self, double angle) noexcept

    @cython.locals(
        count=Py_ssize_t, k=Py_ssize_t, p=Py_ssize_t, q=Py_ssize_t, bottom=Py_ssize_t, end=Py_ssize_t, depth=double,
        middle=double
    )
    cdef void _pair_edges(self, Py_ssize_t slabs) noexcept

    @cython.locals(ring="double[::1]", trapezoid="double[::1]", cut=bint, gone=bint, other_gone=bint, has_two=bint)
    cdef Py_ssize_t _octagon(
        self, Py_ssize_t i, Py_ssize_t k, double low, double high, Py_ssize_t start, Py_ssize_t end
    ) noexcept

cdef Py_ssize_t _add(double[::1] ring, Py_ssize_t n, double x, double y) noexcept
