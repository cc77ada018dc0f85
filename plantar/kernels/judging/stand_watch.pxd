# C types of stand_watch.py. Without a compiler this file is not read.
cimport cython
from libc cimport math


@cython.final
cdef class StandWatch:
    cdef readonly double enough
    cdef Py_ssize_t[::1] begun
    cdef unsigned char[::1] stood
    cdef double[:, ::1] first
    cdef double[:, ::1] place
    cdef readonly double slip
    cdef list over

    cpdef int begin(self, Py_ssize_t foot, Py_ssize_t step) except -1

    cdef tuple _row(self, Py_ssize_t foot)

    @cython.locals(rows=list, foot=Py_ssize_t)
    cpdef list stands(self)

    @cython.locals(dx=double, dy=double)
    cpdef void carry(self, Py_ssize_t foot, double force, double x, double y, double yaw) noexcept
