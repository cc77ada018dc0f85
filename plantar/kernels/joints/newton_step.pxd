cimport cython
from libc cimport math

@cython.final
cdef class NewtonStep:
    cdef const Py_ssize_t[::1] columns
    cdef const double[::1] row_units, column_units
    cdef const Py_ssize_t[::1] movable, places
    cdef const double[::1] middle, half
    cdef double diagonal, least_pivot
    cdef const double[:, ::1] given
    cdef double[::1] error
    cdef const double[::1] configuration
    cdef double[:, ::1] jacobian
    cdef double[::1] step, velocity
    cdef double[:, ::1] normal
    cdef double[::1] column
    cpdef bint solve(self, double largest) except *
    cdef bint _factor(self, Py_ssize_t n) noexcept
    cdef bint _stays(self, Py_ssize_t n, double largest) noexcept
    @cython.locals(largest=double)
    cpdef double worst(self) except? -1.0
    cpdef void write(self) noexcept
