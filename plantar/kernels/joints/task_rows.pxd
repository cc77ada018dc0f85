# C types of task_rows.py. Without a compiler this file is not read.
cimport cython
from ..mechanics cimport rotations

cdef class Rows:
    cpdef bint write(self) noexcept

@cython.final
cdef class PointRows:
    cdef const Py_ssize_t[::1] chain
    cdef const double[:, ::1] motions
    cdef const double[::1] center
    cdef double[:, ::1] jacobian

    @cython.locals(
        chain="const Py_ssize_t[::1]", motions="const double[:, ::1]", center="const double[::1]",
        out="double[:, ::1]", k=Py_ssize_t, i=Py_ssize_t
    )
    cpdef void write(self, double x, double y, double z) noexcept

cdef class TurnRows(Rows):
    cdef const Py_ssize_t[::1] chain
    cdef const double[:, ::1] motions
    cdef const double[:, ::1] wanted
    cdef const double[:, ::1] actual
    cdef double[::1] error
    cdef double[:, ::1] jacobian

    @cython.locals(
        chain="const Py_ssize_t[::1]", motions="const double[:, ::1]", out="double[:, ::1]", k=Py_ssize_t,
        i=Py_ssize_t, j=Py_ssize_t
    )
    cpdef bint write(self) noexcept

cdef class PoseRows(Rows):
    cdef const double[::1] position
    cdef const double[::1] at
    cdef double[::1] error
    cdef PointRows point
    cdef TurnRows turn

    @cython.locals(at="const double[::1]", i=Py_ssize_t)
    cpdef bint write(self) noexcept

cdef class ComRows(Rows):
    cdef const Py_ssize_t[::1] chains
    cdef const Py_ssize_t[::1] ends
    cdef const double[::1] masses
    cdef double share
    cdef const double[:, ::1] motions
    cdef const double[:, ::1] centers
    cdef const Py_ssize_t[::1] trees
    cdef const double[:, ::1] places
    cdef const double[::1] target
    cdef const double[::1] com
    cdef double[::1] error
    cdef double[:, ::1] jacobian

    @cython.locals(
        chains="const Py_ssize_t[::1]", motions="const double[:, ::1]", centers="const double[:, ::1]",
        places="const double[:, ::1]", out="double[:, ::1]", begin=Py_ssize_t, b=Py_ssize_t, k=Py_ssize_t,
        i=Py_ssize_t, j=Py_ssize_t, t=Py_ssize_t, mass=double, x=double, y=double, z=double
    )
    cpdef bint write(self) noexcept
