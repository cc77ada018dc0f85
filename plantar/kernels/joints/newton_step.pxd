# C types of newton_step.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

@cython.final
cdef class NewtonStep:
    cdef const Py_ssize_t[::1] columns
    cdef const double[::1] row_units
    cdef const double[::1] column_units
    cdef const Py_ssize_t[::1] movable
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] middle
    cdef const double[::1] half
    cdef double diagonal
    cdef double least_pivot
    cdef const double[:, ::1] given
    cdef double[::1] error
    cdef const double[::1] configuration
    cdef double[:, ::1] jacobian
    cdef double[::1] step
    cdef double[::1] velocity
    cdef double[:, ::1] normal
    cdef double[::1] column

    @cython.locals(
        normal="double[:, ::1]", step="double[::1]", used="double[:, ::1]", columns="const Py_ssize_t[::1]",
        jacobian="const double[:, ::1]", error="double[::1]", m=Py_ssize_t, n=Py_ssize_t, r=Py_ssize_t, i=Py_ssize_t,
        j=Py_ssize_t, share=double
    )
    cpdef bint solve(self, double largest) except *

    @cython.locals(
        normal="double[:, ::1]", step="double[::1]", column="double[::1]", i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t,
        pivot=double, share=double
    )
    cdef bint _factor(self, Py_ssize_t n) noexcept

    @cython.locals(configuration="const double[::1]", i=Py_ssize_t, k=Py_ssize_t, beside=double)
    cdef bint _stays(self, Py_ssize_t n, double largest) noexcept

    @cython.locals(error="double[::1]", r=Py_ssize_t, value=double, largest=double)
    cpdef double worst(self) except? -1.0

    @cython.locals(i=Py_ssize_t)
    cpdef void write(self) noexcept
