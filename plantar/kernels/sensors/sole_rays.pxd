cimport cython
from libc cimport math
from . cimport ground_rays
from .noise_rows cimport NoiseRows

cdef double _INFINITE, _NONE
cdef object _dot

@cython.final
cdef class SoleRays:
    cdef object own_starts, own_ways
    cdef double lift, most
    cdef const double[::1] origin
    cdef object turned_back
    cdef const double[::1] lowest
    cdef const int[:] ids, kinds
    cdef const double[:, :] sizes
    cdef const double[:] bounds
    cdef const double[:, :] positions, frames
    cdef readonly object starts, ways, lengths, distances
    cdef double[:, ::1] start, way
    cdef double[::1] length, distance
    cdef object sample
    cdef double[::1] told
    cdef double reach, height
    cpdef void limit(self, double reach, double height) noexcept
    cpdef int look(self) except -1
    cpdef bint lies_below(self, double reach, double height) noexcept
    cpdef int aim(self) except -1
    cdef void _shift(self) noexcept
    cpdef int cast(self) except -1
    cpdef void measure(self) noexcept
    cpdef void see_nothing(self) noexcept
    cpdef tell(self, NoiseRows noise, Py_ssize_t row, const Py_ssize_t[::1] dead)
    cdef void _take(self, NoiseRows noise, Py_ssize_t row) noexcept
