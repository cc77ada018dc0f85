cimport cython
from libc cimport math
from ..base cimport work_arrays
from . cimport clean, concave, enclosing, inscribed, parallelogram, rectangle

cdef double _LARGEST
cdef double _INF
cdef double _QUARTER

cdef class ConvexShapes:
    cdef bint lists
    cdef double[::1] ring, work, out
    cdef concave.OutlineRectangles outline
    cdef Py_ssize_t n
    cdef double x, y

    @cython.locals(k=Py_ssize_t, i=Py_ssize_t, turn=int)
    cdef Py_ssize_t _clean(self, const double[:, :] polygon) except -1

    @cython.locals(n=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, ring=double[::1])
    cdef void _take(self, const double[:, :] polygon, bint backwards, double x0, double y0) except *

    @cython.locals(i=Py_ssize_t, corners=double[:, ::1])
    cdef _corners(self, Py_ssize_t count)

    @cython.locals(i=Py_ssize_t, end=Py_ssize_t)
    cdef _flat(self, Py_ssize_t count)

    @cython.locals(i=Py_ssize_t)
    cdef _middle(self, Py_ssize_t count)

    cpdef triangle(self, const double[:, :] polygon)
    cpdef parallelogram(self, const double[:, :] polygon)

    @cython.locals(radius=double)
    cpdef circle(self, const double[:, :] polygon)

    @cython.locals(size=double, after=double, x=double, y=double, i=Py_ssize_t)
    cpdef rectangle(self, const double[:, :] polygon, double angle)

    @cython.locals(
        c=double, s=double, i=Py_ssize_t, j=Py_ssize_t, dx=double, dy=double, along=double, across=double
    )
    cdef bint _leans(self, double angle) noexcept
    cpdef box(self, const double[:, :] polygon)
    cpdef parallelogram_around(self, const double[:, :] polygon)

    @cython.locals(
        low_x=double, low_y=double, high_x=double, high_y=double, x=double, y=double, i=Py_ssize_t,
        corners=double[:, ::1]
    )
    cpdef bounding_box(self, const double[:, :] points)

    cpdef rectangle_in_outline(self, const double[:, :] points, object starts, double angle)
