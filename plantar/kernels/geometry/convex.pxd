cimport cython
from libc cimport math
from . cimport clean
from ..base cimport pointers as memory
from ..base cimport vectors

cdef double _LARGEST
cdef double _INFINITE
cdef double _NONE
cdef double _NOISE
cdef int _FEW

@cython.locals(
    total=double, k=Py_ssize_t, i=Py_ssize_t, x0=double, y0=double, ax=double, ay=double, bx=double, by=double
)
cpdef double area(const double[:, :] polygon) noexcept nogil

@cython.locals(room=OffsetRoom, total=double)
cpdef double area_of(polygon) except? -1.0

@cython.locals(
    k=Py_ssize_t, i=Py_ssize_t, x0=double, y0=double, total=double, cx=double, cy=double, mx=double, my=double,
    size=double, ax=double, ay=double, bx=double, by=double, cross=double
)
cpdef (double, double, double) area_and_centroid(const double[:, :] polygon) noexcept nogil

@cython.locals(
    k=Py_ssize_t, i=Py_ssize_t, inside=bint, best=double, deepest=double, span=double, qx=double, qy=double, ax=double,
    ay=double, bx=double, by=double, lx=double, ly=double, length2=double, across=double, along=double, px=double,
    py=double, t=double, distance2=double
)
cdef (double, double, double) _nearest(const double[:, :] polygon, double turn, double x, double y) noexcept

@cython.locals(turn=int, corners="double[:, ::1]")
cdef (double, double, double) _nearest_of_any(const double[:, :] polygon, double x, double y) except *

@cython.final
cdef class OffsetRoom:
    cdef double[:, ::1] given, lines
    cdef double[:, :, ::1] rings
    cdef double[:, ::1] result

    cdef copied(self, Py_ssize_t size)

@cython.locals(qx=double, qy=double)
cpdef closest_point(polygon, double x, double y)

@cython.locals(room=OffsetRoom, _margin=double, qx=double, qy=double)
cpdef (double, double) nearest(polygon, double x, double y) except *

@cython.locals(room=OffsetRoom, margin=double, _qx=double, _qy=double)
cpdef double signed_margin(polygon, double x, double y) except? -1.0

cpdef seen_from_above(const double[:, :] polygon, const double[:, :] rotation, const double[:] position)

@cython.locals(i=Py_ssize_t, x=double, y=double)
cdef void _place(
    const double[:, :] polygon, const double[:, :] rotation, const double[:] position, double[:, ::1] out
) noexcept

cdef list _FREE

cdef OffsetRoom _borrow(Py_ssize_t corners)

@cython.locals(k=Py_ssize_t, given="double[:, ::1]", values=cython.p_double, i=Py_ssize_t)
cdef const double[:, :] _entered(polygon, OffsetRoom room) except *

@cython.locals(room=OffsetRoom)
cpdef inner_offset(polygon, double distance)

@cython.locals(
    i=Py_ssize_t, size=Py_ssize_t, turn=int, x0=double, y0=double, near=double, corners="double[:, ::1]"
)
cpdef Py_ssize_t offset(const double[:, :] polygon, double distance, OffsetRoom room) except -1

@cython.locals(i=Py_ssize_t, rings="double[:, :, ::1]", result="double[:, ::1]", corners="double[:, ::1]")
cdef Py_ssize_t _shifted(OffsetRoom room, Py_ssize_t size, double x0, double y0, double near) except -1

@cython.locals(
    k=Py_ssize_t, reach=double, i=Py_ssize_t, j=Py_ssize_t, x=double, y=double, used=Py_ssize_t, ax=double, ay=double,
    lx=double, ly=double, length=double, size=Py_ssize_t, left=Py_ssize_t, low=double, high=double, middle=double
)
cdef Py_ssize_t _inner_offset(
    const double[:, :] polygon, double x0, double y0, bint backwards, double distance, double[:, ::1] lines,
    double[:, :, ::1] rings
) noexcept

@cython.locals(kept=Py_ssize_t, line=Py_ssize_t, i=Py_ssize_t, found=bint)
cdef Py_ssize_t _keep_lines(
    double[:, ::1] lines, Py_ssize_t used, double[:, :, ::1] rings, Py_ssize_t size
) noexcept

@cython.locals(
    room=Py_ssize_t, source=Py_ssize_t, line=Py_ssize_t, target=Py_ssize_t, nx=double, ny=double, level=double,
    ex=double, ey=double, tag=double, before=double, count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, cx=double,
    cy=double, here=double, t=double
)
cdef Py_ssize_t _cut(
    double[:, ::1] lines, Py_ssize_t used, double depth, double[:, :, ::1] rings, Py_ssize_t size
) noexcept
