# C types of any_angle.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport work_arrays
from . cimport bracket, rectangle

cdef double _QUARTER
cdef double _LEAST
cdef double _SLIM
cdef int _STEPS
cdef int _SEEDS
cdef double _CLOSE
cdef int _SECTIONS
cdef double _STEP
cdef double _STRIDE
cdef double _LONGEST
cdef double _PROVEN
cdef double _INF

@cython.final
cdef class AnyAngle:
    cdef bint lists
    cdef Py_ssize_t n
    cdef public double best
    cdef public double best_angle
    cdef readonly double gap
    cdef double whole
    cdef public double fine
    cdef readonly double[::1] direction
    cdef double[::1] ring
    cdef double[::1] work
    cdef bracket.Bracket bracket


    cpdef double in_ring(self, double[::1] ring, Py_ssize_t n, double[::1] work, double[::1] out) except -1

    @cython.locals(i=Py_ssize_t, dx=double, dy=double, twice=double, reach2=double)
    cdef void _measure(self, double[::1] points, Py_ssize_t n) noexcept

    cdef double largest(self, double angle, double floor, double[::1] out) except -1

    @cython.locals(
        direction="double[::1]", count=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, known=bint, angle=double, dx=double,
        dy=double, same=double
    )
    cdef Py_ssize_t find_directions(self, double[::1] points, Py_ssize_t n) noexcept

    @cython.locals(k=Py_ssize_t, area=double)
    cdef void seed(self, double[::1] points, Py_ssize_t n, double[::1] out) except *

    cdef void march(self, double[::1] out) except *
    cdef double _behind(self, double angle, double most, double[::1] out) except -1

    @cython.locals(
        bracket=bracket.Bracket, mine=double, at=double, side=double, beside=double, reach=double, angle=double,
        trial=double
    )
    cdef void climb(self, double middle, double area, double[::1] out) except *

cdef double _slope(double area, double before, double back, double lean) noexcept
cdef double _reach(double slope, double curve, double gap) noexcept
cdef double _step(double slope, double curve, double gap, double lean, double least) noexcept
