cimport cython
from libc cimport math
from ..mechanics cimport rotations

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

cdef class Rows:
    cpdef bint write(self) noexcept

@cython.final
cdef class PointRows:
    cdef const Py_ssize_t[::1] chain
    cdef const double[:, ::1] motions
    cdef const double[::1] center
    cdef double[:, ::1] jacobian
    cpdef void write(self, double x, double y, double z) noexcept

cdef class TurnRows(Rows):
    cdef const Py_ssize_t[::1] chain
    cdef const double[:, ::1] motions, wanted, actual
    cdef double[::1] error
    cdef double[:, ::1] jacobian
    cpdef bint write(self) noexcept

cdef class PoseRows(Rows):
    cdef const double[::1] position, at
    cdef double[::1] error
    cdef PointRows point
    cdef TurnRows turn
    cpdef bint write(self) noexcept

cdef class ComRows(Rows):
    cdef const Py_ssize_t[::1] chains, ends
    cdef const double[::1] masses
    cdef double share
    cdef const double[:, ::1] motions, centers
    cdef const Py_ssize_t[::1] trees
    cdef const double[:, ::1] places
    cdef const double[::1] target, com
    cdef double[::1] error
    cdef double[:, ::1] jacobian
    cpdef bint write(self) noexcept

cdef double _LEAST

@cython.final
cdef class Configuration:
    cdef const Py_ssize_t[::1] ways, speeds, turns, rates
    cdef double[::1] configuration
    cdef const double[::1] velocity
    cpdef void move(self) noexcept
    @cython.locals(w=double, x=double, y=double, z=double, i=double, j=double, k=double)
    cdef void _turn(self, Py_ssize_t place, Py_ssize_t rate) noexcept

@cython.final
cdef class TaskStep:
    cdef list rows
    cdef NewtonStep newton
    cdef Configuration configuration
    cdef readonly bint near
    @cython.locals(rows=Rows)
    cpdef bint step(self, double largest) except *
    cpdef void move(self) noexcept
