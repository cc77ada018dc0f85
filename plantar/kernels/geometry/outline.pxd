cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.locals(
    twice=double, sx=double, sy=double, ax=double, ay=double, bx=double, by=double, cross=double, last=Py_ssize_t,
    i=Py_ssize_t
)
cpdef (double, double, double) area_and_centroid(const double[:, :] points, object starts)
@cython.locals(
    twice=double, ax=double, ay=double, bx=double, by=double, first=Py_ssize_t, last=Py_ssize_t, i=Py_ssize_t
)
cpdef list ring_areas(const double[:, :] points, object starts)

cdef class Rings:
    cdef readonly object points, starts, ring_areas

cdef class EdgeTable:
    cdef readonly const Py_ssize_t[::1] cell_start, cell, twin, after, origin
    cdef readonly const double[::1] vertices
    cdef readonly double straight
    cdef readonly bint reuse
    cdef unsigned char[::1] mark
    cdef unsigned char[::1] leaving
    cdef Py_ssize_t[::1] path, place
    cdef double[:, ::1] points
    @cython.locals(
        size=Py_ssize_t, low=Py_ssize_t, k=Py_ssize_t, mark=cython.uchar[::1], leaving=cython.uchar[::1],
        path=Py_ssize_t[::1], place=Py_ssize_t[::1], points=double[:, ::1]
    )
    cdef object _trace(self, bytes active, list starts, list areas)
    @cython.locals(found=Rings)
    cpdef rings(self, bytes active, object kind)
    @cython.locals(twice=double)
    cdef Py_ssize_t _keep(
        self, Py_ssize_t[::1] path, Py_ssize_t low, Py_ssize_t high, double[:, ::1] points, Py_ssize_t used,
        list starts, list areas
    ) except -1
