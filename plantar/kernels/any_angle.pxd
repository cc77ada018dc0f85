# C types of any_angle.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from . cimport concave, rectangle

cdef double _QUARTER
cdef double _GOLDEN
cdef int _PIECES
cdef int _SEEDS
cdef double _FINE
cdef double _CLOSE
cdef int _SECTIONS
cdef double _STEP

@cython.final
cdef class AnyAngle:
    cdef bint lists
    cdef bint convex
    cdef Py_ssize_t n
    cdef double best
    cdef double best_angle
    cdef double[::1] stack
    cdef double[::1] ring
    cdef double[::1] work
    cdef readonly concave.OutlineRectangles outline

    cdef _numbers(self, Py_ssize_t size)

    cpdef double in_ring(self, double[::1] ring, Py_ssize_t n, double[::1] work, double[::1] out) except -1

    @cython.locals(outline=concave.OutlineRectangles, parts=Py_ssize_t, best_part=Py_ssize_t, k=Py_ssize_t)
    cpdef double in_outline(self, const double[:, :] points, object starts, bint apart, double[::1] out) except -1

    cdef double _largest(self, double angle, double floor, double[::1] out) except -1

    @cython.locals(
        stack="double[::1]", count=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, known=bint, angle=double, area=double
    )
    cdef void _seed(self, double[::1] points, Py_ssize_t n, double[::1] out) except *

    @cython.locals(stack="double[::1]", reach2=double, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, top=Py_ssize_t)
    cdef void _search(self, double[::1] points, Py_ssize_t n, double[::1] out) except *

    cdef void _refine(self, double low, double middle, double high, double area, double[::1] out) except *

    cdef void _climb(self, double low, double middle, double high, double area, double[::1] out) except *
