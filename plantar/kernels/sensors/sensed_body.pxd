# C types of sensed_body.py. Without a compiler this file is not read.
cimport cython
from .noise_rows cimport NoiseRows

@cython.final
cdef class SensedBody:
    cdef const double[::1] positions
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] rate
    cdef const double[::1] force
    cdef NoiseRows noise
    cdef const double[::1] offsets
    cdef const double[::1] bias
    cdef tuple arrays
    cdef double[::1] told_joints
    cdef double[::1] told_rate
    cdef double[::1] told_force

    cpdef tuple read(self)

    @cython.locals(count=Py_ssize_t, i=Py_ssize_t)
    cdef void _take(self, Py_ssize_t row) noexcept
