# C types of sole_rays.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from . cimport ground_rays
from .noise_rows cimport NoiseRows

cdef double _INFINITE
cdef double _NONE
cdef object _dot

@cython.final
cdef class SoleRays:
    cdef object own_starts
    cdef object own_ways
    cdef double lift
    cdef double most
    cdef const double[::1] origin
    cdef object turned_back
    cdef const double[::1] lowest
    cdef const int[:] ids
    cdef const int[:] kinds
    cdef const double[:, :] sizes
    cdef const double[:] bounds
    cdef const double[:, :] positions
    cdef const double[:, :] frames
    cdef readonly object starts
    cdef readonly object ways
    cdef readonly object lengths
    cdef readonly object distances
    cdef double[:, ::1] start
    cdef double[:, ::1] way
    cdef double[::1] length
    cdef double[::1] distance
    cdef object sample
    cdef double[::1] told

    @cython.locals(tilt=double)
    cpdef bint lies_below(self, double reach, double height) noexcept

    cpdef int aim(self) except -1

    @cython.locals(i=Py_ssize_t, j=Py_ssize_t)
    cdef void _shift(self) noexcept

    cpdef int cast(self) except -1

    @cython.locals(i=Py_ssize_t, length=double)
    cpdef void measure(self) noexcept

    @cython.locals(i=Py_ssize_t)
    cpdef void see_nothing(self) noexcept

    @cython.locals(i=Py_ssize_t)
    cpdef tell(self, NoiseRows noise, Py_ssize_t row, const Py_ssize_t[::1] dead)

    @cython.locals(i=Py_ssize_t, value=double)
    cdef void _take(self, NoiseRows noise, Py_ssize_t row) noexcept
