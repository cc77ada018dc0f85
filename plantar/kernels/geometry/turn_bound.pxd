# C types of turn_bound.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport work_arrays
from . cimport rectangle

cdef Py_ssize_t _LINES
cdef Py_ssize_t _CHAIN
cdef int _STEPS
cdef double _TOUCH
cdef double _WIDER
cdef double _INF

@cython.final
cdef class TurnBound:
    cdef bint lists
    cdef Py_ssize_t lines
    cdef double[::1] line
    cdef double[::1] ring
    cdef double[::1] cut
    cdef double[::1] work
    cdef double[::1] corner
    cdef Py_ssize_t bearings
    cdef Py_ssize_t[::1] bearing
    cdef Py_ssize_t[::1] side
    cdef Py_ssize_t[::1] edge
    cdef Py_ssize_t known_bearings
    cdef Py_ssize_t known_lines
    cdef Py_ssize_t[::1] known_bearing
    cdef Py_ssize_t[::1] known_side
    cdef Py_ssize_t[::1] known_edge
    cdef double[::1] known_reach
    cdef Py_ssize_t[::1] foremost
    cdef double[::1] most
    cdef double[::1] level
    cdef double[::1] middles
    cdef double[::1] known_middles
    cdef double[::1] centre
    cdef double[::1] sides
    cdef double lean
    cdef double aside
    cdef double x
    cdef double y


    @cython.locals(side=Py_ssize_t, wide=Py_ssize_t, size=Py_ssize_t, at=double, sign=double, reach=double)
    cdef void narrow(self, double[::1] ring, Py_ssize_t n, double[::1] corner, double least, double[::1] box) noexcept

    @cython.locals(
        middle=double, side=Py_ssize_t, wanted=double, at=double, lean=double, aside=double, x=double, y=double
    )
    cdef void clear(
        self, double[::1] xs, double[::1] ys, Py_ssize_t[::1] start, Py_ssize_t rings, double[::1] box,
        double[::1] around, double half, double target, double wanted_low, double wanted_high, double[::1] reach
    ) except *

    @cython.locals(
        area=double, at=double, left=double, beside=double, lean=double, moved=double, before=double, bend=double,
        gap=double, slope=double, root=double, far=double
    )
    cdef double _advance(
        self, double[::1] xs, double[::1] ys, double[::1] box, double sign, double wanted, double middle, double target
    ) noexcept

    @cython.locals(width=double, height=double, reach=double, push=double, left=double)
    cdef void _stand(self, double[::1] box, double turn, double at) noexcept

    @cython.locals(
        close=double, across=double, along=double, cosine=double, sine=double, k=Py_ssize_t, ax=double, ay=double,
        dx=double, dy=double, x=double, y=double
    )
    cdef double _push(self, double width, double height, double turn) noexcept

    @cython.locals(x=double, y=double, cosine=double, sine=double)
    cdef void _find_centre(self, double turn) noexcept
    cdef double _farthest(self, double[::1] box, double x, double y) noexcept

    @cython.locals(k=Py_ssize_t)
    cdef void _find_middles(self, double[::1] box, double[::1] around) noexcept

    @cython.locals(k=Py_ssize_t, more=double)
    cdef void _widen_middles(self) noexcept

    cdef void forget(self) noexcept

    @cython.locals(k=Py_ssize_t)
    cdef bint _is_known(self) noexcept

    @cython.locals(k=Py_ssize_t)
    cdef void _keep(self) noexcept

    @cython.locals(
        most="double[::1]", level="double[::1]", v=Py_ssize_t, k=Py_ssize_t, count=Py_ssize_t, side=Py_ssize_t, end=Py_ssize_t, x=double,
        y=double, gap=double, along=double, across=double, reached=double
    )
    cdef void _find_bearing(
        self, double[::1] xs, double[::1] ys, Py_ssize_t m, double[::1] box, double half
    ) except *

    @cython.locals(k=Py_ssize_t, dx=double, dy=double)
    cdef bint _is_behind(
        self, double[::1] xs, double[::1] ys, Py_ssize_t side, double x, double y, double lean
    ) noexcept

    @cython.locals(
        line="double[::1]", r=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t, low=Py_ssize_t, high=Py_ssize_t, dx=double,
        dy=double, qx=double, qy=double, lx=double, ly=double
    )
    cdef void _find_lines(
        self, double[::1] xs, double[::1] ys, Py_ssize_t[::1] start, Py_ssize_t rings, double[::1] box, double lean
    ) noexcept

    @cython.locals(
        x=double, y=double, dx=double, dy=double, ex=double, ey=double, qx=double, qy=double, gap=double,
        following=Py_ssize_t, turned=bint, beside=bint
    )
    cdef bint _is_anchored(
        self, double[::1] xs, double[::1] ys, Py_ssize_t low, Py_ssize_t high, Py_ssize_t end, Py_ssize_t other,
        Py_ssize_t step, double[::1] box, double lean
    ) noexcept

    @cython.locals(
        n=Py_ssize_t, k=Py_ssize_t, i=Py_ssize_t, size=Py_ssize_t, side=Py_ssize_t, open_sides=bint,
        ring="double[::1]", sides="double[::1]", x=double, y=double, left=double, right=double, bottom=double, top=double, area=double
    )
    cdef double _room(self, double[::1] xs, double[::1] ys, double[::1] box, double turn) noexcept

@cython.locals(count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, before=double, after=double, share=double)
cpdef Py_ssize_t cut_ring(double[::1] ring, Py_ssize_t n, double nx, double ny, double level, double[::1] out) noexcept
