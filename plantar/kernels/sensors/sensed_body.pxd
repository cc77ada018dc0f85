cimport cython
from .noise_rows cimport NoiseRows

@cython.final
cdef class SensedBody:
    cdef const double[::1] positions
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] rate, force
    cdef NoiseRows noise
    cdef const double[::1] offsets, bias
    cdef tuple arrays
    cdef double[::1] told_joints, told_rate, told_force
    cpdef tuple read(self)
    cdef void _take(self, Py_ssize_t row) noexcept
