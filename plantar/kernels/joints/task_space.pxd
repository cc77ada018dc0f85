cimport cython
from libc cimport math

@cython.final
cdef class TaskSpace:
    cdef readonly Py_ssize_t size, used
    cdef readonly double[::1] y
    cdef readonly double[:, ::1] columns
    cdef readonly double[::1] sizes, full, missing
    cdef readonly Py_ssize_t[::1] order
    cdef double[:, ::1] factor, vectors, normal
    cdef double[::1] scale, left, sums
    cdef Py_ssize_t room
    cdef void _make_room(self, Py_ssize_t count) except *
    @cython.locals(total=double)
    cpdef bint begin(self, const double[:, ::1] mass) except *
    cpdef void push(self, double[::1] torque) except *
    @cython.locals(largest=double, longest=double, total=double)
    cpdef tuple own(self, const double[:, ::1] jacobian, const double[::1] wanted, bint meet, double least)
    cpdef void meet(self, Py_ssize_t rank) except *
    @cython.locals(largest=double, total=double)
    cpdef void fit(self, Py_ssize_t rank, Py_ssize_t count, double least) except *
    @cython.locals(total=double)
    cpdef void acceleration(self, double[::1] out) except *
    @cython.locals(a=double, b=double, c=double, d=double)
    cdef void _turn(self, double[::1] row) noexcept
    cdef void _turn_all(self, Py_ssize_t count) noexcept
    cdef void _norms(self, Py_ssize_t begin, Py_ssize_t count, double[::1] out) noexcept
    @cython.locals(squares=double)
    cdef double _bound(self, Py_ssize_t rank) noexcept
    cdef void _swap(self, Py_ssize_t a, Py_ssize_t b) noexcept
    @cython.locals(total=double)
    cdef void _reflect(self, Py_ssize_t place, Py_ssize_t count, double smallest) noexcept
