cimport cython
from libc cimport math

@cython.final
cdef class StandWatch:
    cdef readonly double enough
    cdef Py_ssize_t[::1] begun
    cdef unsigned char[::1] stood
    cdef double[:, ::1] first, place
    cdef readonly double slip
    cdef list over
    cpdef int begin(self, Py_ssize_t foot, Py_ssize_t step) except -1
    cdef tuple _row(self, Py_ssize_t foot)
    cpdef list stands(self)
    cpdef void carry(self, Py_ssize_t foot, double force, double x, double y, double yaw) noexcept
