# C types of corridors.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from cpython cimport exc as signals
from ..base cimport work_arrays

cdef double _MOST
cdef double _MERGE
cdef double _LEAST
cdef double _ROUNDING
cdef double _INF
cdef Py_ssize_t _ASK


@cython.final
cdef class Corridors:
    cdef bint lists
    cdef public Py_ssize_t spent
    cdef Py_ssize_t next_look
    cdef double limit
    cdef Py_ssize_t points
    cdef Py_ssize_t columns
    cdef Py_ssize_t many
    cdef readonly Py_ssize_t boxes
    cdef readonly double[::1] box
    cdef double[::1] stack
    cdef Py_ssize_t[::1] path
    cdef double least_x
    cdef double pitch
    cdef double shift
    cdef double cosine
    cdef double sine
    cdef double floor
    cdef bint peak
    cdef double[::1] xs
    cdef double[::1] ys
    cdef Py_ssize_t[::1] first
    cdef Py_ssize_t[::1] filled
    cdef double[::1] crossing
    cdef double[::1] low
    cdef double[::1] high
    cdef Py_ssize_t[::1] far

    cpdef void restart(self) noexcept
    cpdef void allow(self, double work) noexcept
    cdef _make_room(self, Py_ssize_t points, Py_ssize_t columns)

    @cython.locals(
        m=Py_ssize_t, xs="double[::1]", ys="double[::1]", cosine=double, sine=double, low=double, high=double,
        width=double, i=Py_ssize_t, k=Py_ssize_t, t=Py_ssize_t, columns=Py_ssize_t
    )
    cpdef void sweep(
        self, double[::1] points, Py_ssize_t[::1] start, Py_ssize_t rings, double angle, double half, double pitch,
        double floor, bint peak
    ) except *
    @cython.locals(i=Py_ssize_t)
    cdef void _add_all(self, Py_ssize_t m, double low, double high) noexcept
    cdef Py_ssize_t _column(self, double x) noexcept
    cdef double _place(self, Py_ssize_t column) noexcept

    @cython.locals(
        xs="double[::1]", ys="double[::1]", first="Py_ssize_t[::1]", filled="Py_ssize_t[::1]", crossing="double[::1]",
        k=Py_ssize_t, r=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, total=Py_ssize_t, across=Py_ssize_t, a=Py_ssize_t,
        b=Py_ssize_t, side=double, low=Py_ssize_t, high=Py_ssize_t, slope=double, y=double, p=Py_ssize_t
    )
    cdef void _cut(self, Py_ssize_t[::1] start, Py_ssize_t rings, Py_ssize_t columns) except *
    cdef _make_many(self, Py_ssize_t total)

    @cython.locals(
        first="Py_ssize_t[::1]", crossing="double[::1]", low="double[::1]", high="double[::1]", count=Py_ssize_t,
        p=Py_ssize_t, q=Py_ssize_t, k=Py_ssize_t, depth=double, bottom=double, top=double, before=double
    )
    cdef void _free(self, Py_ssize_t columns, double rounding) noexcept

    @cython.locals(
        first="Py_ssize_t[::1]", low="double[::1]", high="double[::1]", far="Py_ssize_t[::1]", least=double,
        shift=double, k=Py_ssize_t, t=Py_ssize_t, u=Py_ssize_t, v=Py_ssize_t
    )
    cdef void _reach(self, Py_ssize_t columns) noexcept

    @cython.locals(reach=double, width=double)
    cdef double _bound(self, Py_ssize_t columns, double height) noexcept

    @cython.locals(
        first="Py_ssize_t[::1]", low="double[::1]", high="double[::1]", far="Py_ssize_t[::1]", shift=double,
        way_low=double, way_high=double, u=Py_ssize_t, bottom=double, top=double, top_of=Py_ssize_t, k=Py_ssize_t,
        bottom_y=double, top_y=double, height=double, least_y=double, most_y=double, bound=double, back=double
    )
    cdef void _walk(self, Py_ssize_t begin, Py_ssize_t t, Py_ssize_t columns) except *

    @cython.locals(middle=Py_ssize_t)
    cdef Py_ssize_t _first_above(self, Py_ssize_t low, Py_ssize_t high, double y) noexcept
    cdef void _put(
        self, Py_ssize_t at, Py_ssize_t k, double bottom, double top, double height, double least_y, double most_y
    ) except *

    @cython.locals(path="Py_ssize_t[::1]", stack="double[::1]", i=Py_ssize_t)
    cdef _widen(self)

    @cython.locals(
        aside=double, x1=double, x2=double, y1=double, y2=double, lean=double, box="double[::1]", area=double,
        a=double, b=double, c=double, d=double, mine=double, i=Py_ssize_t
    )
    cdef void _add(
        self, Py_ssize_t begin, Py_ssize_t k, double least_y, double most_y, double height, double bound
    ) except *
