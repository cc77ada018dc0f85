cimport cython
from libc cimport math
from ..base cimport work_arrays
from . cimport clean, concave, enclosing, inscribed, parallelogram, rectangle

cdef double _LARGEST, _INF, _QUARTER

cdef class ConvexShapes:
    cdef bint lists
    cdef double[::1] ring, work, out
    cdef concave.OutlineRectangles outline
    cdef Py_ssize_t n
    cdef double x, y
    cdef Py_ssize_t _clean(self, const double[:, :] polygon) except -1
    cdef void _take(self, const double[:, :] polygon, bint backwards, double x0, double y0) except *
    @cython.locals(corners=double[:, ::1])
    cdef _corners(self, Py_ssize_t count)
    cdef _flat(self, Py_ssize_t count)
    cdef _middle(self, Py_ssize_t count)
    cpdef triangle(self, const double[:, :] polygon)
    cpdef parallelogram(self, const double[:, :] polygon)
    cpdef circle(self, const double[:, :] polygon)
    cpdef rectangle(self, const double[:, :] polygon, double angle)
    cdef bint _leans(self, double angle) noexcept
    cpdef box(self, const double[:, :] polygon)
    cpdef parallelogram_around(self, const double[:, :] polygon)
    @cython.locals(corners=double[:, ::1])
    cpdef bounding_box(self, const double[:, :] points)
    cpdef rectangle_in_outline(self, const double[:, :] points, object starts, double angle)
