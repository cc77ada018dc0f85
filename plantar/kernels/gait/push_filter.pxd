cimport cython
from libc cimport math

@cython.final
cdef class PushFilter:
    cdef double share, begins, ends
    cdef readonly double x, y
    cdef readonly bint acts
    cpdef void rest(self) noexcept
    cpdef void update(self, double x, double y, double pendulum_x, double pendulum_y) noexcept
