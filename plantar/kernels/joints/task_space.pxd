# C types of task_space.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

@cython.final
cdef class TaskSpace:
    cdef readonly Py_ssize_t size
    cdef readonly Py_ssize_t used
    cdef readonly double[::1] y
    cdef readonly double[:, ::1] columns
    cdef readonly double[::1] sizes
    cdef readonly double[::1] full
    cdef readonly double[::1] missing
    cdef readonly Py_ssize_t[::1] order
    cdef double[:, ::1] factor
    cdef double[:, ::1] vectors
    cdef double[:, ::1] normal
    cdef double[::1] scale
    cdef double[::1] left
    cdef double[::1] sums
    cdef Py_ssize_t room

    cdef void _make_room(self, Py_ssize_t count) except *

    @cython.locals(
        n=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, factor="double[:, ::1]", total=double
    )
    cpdef bint begin(self, const double[:, ::1] mass) except *

    @cython.locals(i=Py_ssize_t)
    cpdef void push(self, double[::1] torque) except *

    @cython.locals(
        n=Py_ssize_t, count=Py_ssize_t, first=Py_ssize_t, rank=Py_ssize_t, best=Py_ssize_t, i=Py_ssize_t,
        j=Py_ssize_t, columns="double[:, ::1]", sizes="double[::1]", left="double[::1]", missing="double[::1]",
        order="Py_ssize_t[::1]", y="double[::1]", full="double[::1]", largest=double, longest=double, total=double
    )
    cpdef tuple own(self, const double[:, ::1] jacobian, const double[::1] wanted, bint meet, double least)

    @cython.locals(
        first=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, columns="double[:, ::1]", missing="double[::1]", y="double[::1]",
        total=double
    )
    cpdef void meet(self, Py_ssize_t rank) except *

    @cython.locals(
        first=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, columns="double[:, ::1]", missing="double[::1]",
        normal="double[:, ::1]", largest=double, share=double, total=double
    )
    cpdef void fit(self, Py_ssize_t rank, Py_ssize_t count, double least) except *

    @cython.locals(
        n=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, factor="double[:, ::1]", vectors="double[:, ::1]", total=double
    )
    cpdef void acceleration(self, double[::1] out) except *

    @cython.locals(
        n=Py_ssize_t, begin=Py_ssize_t, end=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, factor="double[:, ::1]",
        vectors="double[:, ::1]", a=double, b=double, c=double, d=double, total=double
    )
    cdef void _turn(self, double[::1] row) noexcept

    @cython.locals(
        n=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, factor="double[:, ::1]", vectors="double[:, ::1]",
        columns="double[:, ::1]", sums="double[::1]", share=double
    )
    cdef void _turn_all(self, Py_ssize_t count) noexcept

    @cython.locals(i=Py_ssize_t, j=Py_ssize_t, columns="double[:, ::1]")
    cdef void _norms(self, Py_ssize_t begin, Py_ssize_t count, double[::1] out) noexcept

    @cython.locals(
        first=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, columns="double[:, ::1]", full="double[::1]",
        column="double[::1]", squares=double, total=double
    )
    cdef double _bound(self, Py_ssize_t rank) noexcept

    @cython.locals(
        i=Py_ssize_t, columns="double[:, ::1]", sizes="double[::1]", left="double[::1]", order="Py_ssize_t[::1]",
        full="double[::1]"
    )
    cdef void _swap(self, Py_ssize_t a, Py_ssize_t b) noexcept

    @cython.locals(
        n=Py_ssize_t, first=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, columns="double[:, ::1]", y="double[::1]",
        vector="double[::1]", sums="double[::1]", sizes="double[::1]", left="double[::1]", share=double,
        total=double, length=double, head=double, scale=double
    )
    cdef void _reflect(self, Py_ssize_t place, Py_ssize_t count, double smallest) noexcept
