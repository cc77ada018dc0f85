cimport cython
from libc cimport math
from . cimport clean
from ..base cimport pointers as memory
from ..base cimport vectors

cdef double _LARGEST, _INFINITE, _NONE, _NOISE
cdef int _FEW
@cython.locals(total=double)
cpdef double area(const double[:, :] polygon) noexcept nogil
cpdef double area_of(polygon) except? -1.0
@cython.locals(total=double, cx=double, cy=double, mx=double, my=double, size=double, ax=double, ay=double)
cpdef (double, double, double) area_and_centroid(const double[:, :] polygon) noexcept nogil
@cython.locals(inside=bint, deepest=double, span=double)
cdef (double, double, double) _nearest(const double[:, :] polygon, double turn, double x, double y) noexcept
cpdef double margin_of_clean(const double[:, :] polygon, double x, double y) noexcept
@cython.locals(corners="double[:, ::1]")
cdef (double, double, double) _nearest_of_any(const double[:, :] polygon, double x, double y) except *

@cython.final
cdef class OffsetRoom:
    cdef double[:, ::1] given, lines
    cdef double[:, :, ::1] rings
    cdef double[:, ::1] result
    cdef copied(self, Py_ssize_t size)

cpdef closest_point(polygon, double x, double y)
cpdef (double, double) nearest(polygon, double x, double y) except *
cpdef double signed_margin(polygon, double x, double y) except? -1.0
cpdef seen_from_above(const double[:, :] polygon, const double[:, :] rotation, const double[:] position)
cdef void _place(
    const double[:, :] polygon, const double[:, :] rotation, const double[:] position, double[:, ::1] out
) noexcept
cdef list _FREE
cdef OffsetRoom _borrow(Py_ssize_t corners)
cdef const double[:, :] _entered(polygon, OffsetRoom room) except *
cpdef inner_offset(polygon, double distance)
@cython.locals(size=Py_ssize_t, corners="double[:, ::1]")
cpdef Py_ssize_t offset(const double[:, :] polygon, double distance, OffsetRoom room) except -1
@cython.locals(i=Py_ssize_t, corners="double[:, ::1]")
cdef Py_ssize_t _shifted(OffsetRoom room, Py_ssize_t size, double x0, double y0, double near) except -1
@cython.locals(reach=double, x=double, y=double, low=double)
cdef Py_ssize_t _inner_offset(
    const double[:, :] polygon, double x0, double y0, bint backwards, double distance, double[:, ::1] lines,
    double[:, :, ::1] rings
) noexcept
cdef Py_ssize_t _keep_lines(double[:, ::1] lines, Py_ssize_t used, double[:, :, ::1] rings, Py_ssize_t size) noexcept
cdef Py_ssize_t _cut(
    double[:, ::1] lines, Py_ssize_t used, double depth, double[:, :, ::1] rings, Py_ssize_t size
) noexcept
