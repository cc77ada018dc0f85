# C types of turn_bound.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from . cimport rectangle, work_arrays

cdef Py_ssize_t _LINES
cdef Py_ssize_t _CHAIN
cdef int _STEPS
cdef double _BEND
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


    @cython.locals(side=Py_ssize_t, wide=Py_ssize_t, size=Py_ssize_t, at=double, sign=double, reach=double)
    cdef void narrow(self, double[::1] ring, Py_ssize_t n, double[::1] corner, double least, double[::1] box) noexcept

    @cython.locals(
        middle=double, middle_lean=double, side=Py_ssize_t, sign=double, wanted=double, area=double, lean=double,
        at=double, left=double, bend=double, gap=double, beside=double, before=double, slope=double, root=double,
        far=double
    )
    cdef void clear(
        self, double[::1] xs, double[::1] ys, Py_ssize_t[::1] start, Py_ssize_t rings, double[::1] box, double half,
        double target, double wanted_low, double wanted_high, double[::1] reach
    ) except *

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
        ring="double[::1]", x=double, y=double, left=double, right=double, bottom=double, top=double, area=double
    )
    cdef double _room(self, double[::1] xs, double[::1] ys, double[::1] box, double turn) noexcept

@cython.locals(count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, before=double, after=double, share=double)
cdef Py_ssize_t _cut(double[::1] ring, Py_ssize_t n, double nx, double ny, double level, double[::1] out) noexcept
