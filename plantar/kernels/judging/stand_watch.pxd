# C types of stand_watch.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

@cython.final
cdef class StandWatch:
    cdef readonly double enough
    cdef readonly unsigned char[::1] stood
    cdef double[:, ::1] first
    cdef readonly double[:, ::1] place
    cdef readonly double[::1] slip

    cpdef void begin(self, Py_ssize_t foot) noexcept

    @cython.locals(dx=double, dy=double, slip=double)
    cpdef void carry(self, Py_ssize_t foot, double force, double x, double y, double yaw) noexcept
