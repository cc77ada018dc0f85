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
