cimport cython
from libc cimport math
from ..geometry cimport clean, convex

@cython.locals(total=double)
cpdef bint spread_whole(
    const double[:, ::1] u, const double[::1] area, const double[:, ::1] inverse, double x, double y, double force,
    const Py_ssize_t[::1] cells, double[::1] out
) noexcept
@cython.locals(
    m00=double, m01=double, m02=double, m11=double, m12=double, m22=double, total=double, pressure=double, carries=bint
)
cpdef bint spread_part(
    const double[:, ::1] u, const double[::1] area, double x, double y, double force, unsigned char[::1] active,
    const Py_ssize_t[::1] cells, double[::1] out
) noexcept

cdef (double, double, double, double) _solved(
    double m00, double m01, double m02, double m11, double m12, double m22, double x, double y, double z
) noexcept

cdef double _EXACT

@cython.locals(total=double, cx=double, cy=double, spread=double, scale=double)
cdef (double, double, double) _centred(double[:, ::1] rows, Py_ssize_t cells, double least) noexcept

@cython.locals(
    a=double, b=double, c=double, step_a=double, step_b=double, step_c=double, slope=double, value=double, rate=double,
    m00=double, m01=double, m02=double, m11=double, m12=double, m22=double, determinant=double, ridge=double
)
cdef (bint, double, double, double) _tilted(
    double[:, ::1] rows, Py_ssize_t cells, double x, double y, Py_ssize_t tries
) noexcept

@cython.locals(least=double)
cdef bint _all_carry(double[:, ::1] rows, Py_ssize_t cells, double a, double b, double c) noexcept

@cython.locals(x=double, y=double)
cpdef tuple patch_key(points, double grid)

@cython.final
cdef class PressedPatch:
    cdef readonly Py_ssize_t[::1] cells
    cdef readonly double[::1] area
    cdef readonly double[:, ::1] u, inverse, reach
    cdef readonly unsigned char[::1] carried
    cdef int turn
    cdef double cx, cy, scale
    cdef readonly double x, y
    cpdef bint spread(self, double force, double x, double y, double[::1] out) except *
    @cython.locals(some=bint)
    cdef bint _some_carried(self) noexcept
    cdef int _to_reach(self) except -1
    cpdef bint part(self, double force, double[::1] out) noexcept
    @cython.locals(a=double, b=double, c=double, total=double, pressure=double, rows="double[:, ::1]")
    cpdef int settle(self, double force, double[::1] out) except -1
    @cython.locals(total=double, pressure=double)
    cdef double _press(self, double a, double b, double c) noexcept
