# C types of outline.py. Without a compiler this file is not read.
cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.locals(
    x0=double, y0=double, twice=double, sx=double, sy=double, ax=double, ay=double, bx=double, by=double, cross=double,
    r=Py_ssize_t, last=Py_ssize_t, i=Py_ssize_t
)
cpdef (double, double, double) area_and_centroid(const double[:, :] points, object starts)

@cython.locals(
    areas=list, twice=double, ax=double, ay=double, bx=double, by=double, r=Py_ssize_t, first=Py_ssize_t,
    last=Py_ssize_t, i=Py_ssize_t
)
cpdef list ring_areas(const double[:, :] points, object starts)

cdef class Rings:
    cdef readonly object points
    cdef readonly object starts
    cdef readonly object ring_areas

cdef class EdgeTable:
    cdef readonly const Py_ssize_t[::1] cell_start
    cdef readonly const Py_ssize_t[::1] cell
    cdef readonly const Py_ssize_t[::1] twin
    cdef readonly const Py_ssize_t[::1] after
    cdef readonly const Py_ssize_t[::1] origin
    cdef readonly const double[::1] vertices
    cdef readonly double straight
    cdef readonly bint reuse
    cdef unsigned char[::1] mark
    cdef unsigned char[::1] leaving
    cdef Py_ssize_t[::1] path
    cdef Py_ssize_t[::1] place
    cdef double[:, ::1] points

    @cython.locals(
        n=Py_ssize_t, edges=Py_ssize_t, places=Py_ssize_t, count=Py_ssize_t, pinched=bint, i=Py_ssize_t, h=Py_ssize_t,
        t=Py_ssize_t, v=Py_ssize_t, first=Py_ssize_t, size=Py_ssize_t, low=Py_ssize_t, k=Py_ssize_t, used=Py_ssize_t,
        mark=cython.uchar[::1], leaving=cython.uchar[::1], path=Py_ssize_t[::1], place=Py_ssize_t[::1], points=double[:, ::1]
    )
    cdef object _trace(self, bytes active, list starts, list areas)

    @cython.locals(starts=list, areas=list)
    cpdef walk(self, bytes active)

    @cython.locals(found=Rings, starts=list, areas=list)
    cpdef rings(self, bytes active, object kind)

    @cython.locals(
        base=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t, c=Py_ssize_t, k=Py_ssize_t, ax=double, ay=double, bx=double,
        by=double, cx=double, cy=double, ux=double, uy=double, wx=double, wy=double, ox=double, oy=double,
        turn=double, twice=double
    )
    cdef Py_ssize_t _keep(
        self, Py_ssize_t[::1] path, Py_ssize_t low, Py_ssize_t high, double[:, ::1] points, Py_ssize_t used,
        list starts, list areas
    ) except -1
