cimport cython
from .sole cimport SoleKernel, SoleScratch

cdef double _INFINITE
cdef double _NONE

@cython.locals(scratch=SoleScratch)
cpdef wrenches(SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[:, ::1] out)

@cython.locals(
    frames=Py_ssize_t, n=Py_ssize_t, columns="const double[:, ::1]", k=Py_ssize_t, i=Py_ssize_t,
    lever_x="const double[::1]", lever_y="const double[::1]", f=double, az=double, ax=double,
    ay=double, bz=double, bx=double, by=double, cz=double, cx=double, cy=double, dz=double,
    dx=double, dy=double, fx=double, fy=double, fz=double, tx=double, ty=double, tz=double
)
cdef void _wrenches(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[::1] kept,
    double[:, ::1] out
) noexcept nogil

@cython.locals(scratch=SoleScratch)
cpdef loads(SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[:, ::1] out)

@cython.locals(
    n=Py_ssize_t, columns="const double[:, ::1]", areas="const double[::1]", k=Py_ssize_t, i=Py_ssize_t,
    lever_x="const double[::1]", lever_y="const double[::1]", f=double,
    part=double, fx=double, fy=double, fz=double, tx=double, ty=double, tz=double, area=double, sx=double, sy=double
)
cdef void _loads(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, double[::1] kept,
    double[::1] covered, double[:, ::1] out
) noexcept nogil

@cython.locals(scratch=SoleScratch, done=Py_ssize_t)
cpdef Py_ssize_t hulls(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, Py_ssize_t[::1] size,
    double[:, ::1] measure, double[:, ::1] points
) except -1

@cython.locals(
    filled=Py_ssize_t, room=Py_ssize_t, k=Py_ssize_t, found=Py_ssize_t, area=double, x=double, y=double
)
cdef Py_ssize_t _hulls(
    SoleKernel sole, const double[:, ::1] force, double threshold, double saturation, SoleScratch scratch,
    Py_ssize_t[::1] size, double[:, ::1] measure, double[:, ::1] points
) noexcept nogil
