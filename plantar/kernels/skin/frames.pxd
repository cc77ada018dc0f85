cimport cython
from .sole cimport SoleKernel, SoleScratch

cdef double _INFINITE, _NONE
cpdef wrenches(SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[:, ::1] out)
@cython.locals(
    f=double, az=double, ax=double, ay=double, bz=double, bx=double, by=double, cz=double, cx=double, cy=double,
    dz=double, dx=double, dy=double, fx=double, fy=double, fz=double, tx=double, ty=double, tz=double
)
cdef void _wrenches(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[::1] kept,
    double[:, ::1] out
) noexcept nogil
cpdef loads(SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[:, ::1] out)
@cython.locals(
    f=double, part=double, fx=double, fy=double, fz=double, tx=double, ty=double, tz=double, area=double, sx=double,
    sy=double
)
cdef void _loads(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[::1] kept,
    double[::1] covered, double[:, ::1] out
) noexcept nogil
cpdef Py_ssize_t hulls(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, Py_ssize_t[::1] size,
    double[:, ::1] measure, double[:, ::1] points
) except -1
cdef Py_ssize_t _hulls(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, SoleScratch scratch,
    Py_ssize_t[::1] size, double[:, ::1] measure, double[:, ::1] points
) noexcept nogil
