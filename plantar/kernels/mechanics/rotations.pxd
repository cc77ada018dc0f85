cimport cython
from libc cimport math
from ..base cimport vectors

cdef double _SMALL
cpdef void turn(const double[:, ::1] rotation, const double[::1] vector, double[::1] out) noexcept
cpdef void turn_back(const double[:, ::1] rotation, const double[::1] vector, double[::1] out) noexcept
cpdef void multiply(const double[:, ::1] a, const double[:, ::1] b, double[:, ::1] out) noexcept
@cython.locals(xx=double, xy=double, xz=double, yx=double, yy=double, yz=double, zx=double, zy=double, zz=double)
cpdef (double, double, double, double, double, double, double, double, double) between(
    const double[:, :] a, const double[:, :] b
) noexcept
cpdef void exponential(double x, double y, double z, double[:, ::1] out) noexcept
cpdef object rotation_of(double x, double y, double z)
@cython.locals(s=double, c=double)
cdef (double, double, double, double, double, double, double, double, double) _exponential(
    double x, double y, double z
) noexcept
cpdef void orthonormalise(const double[:, ::1] rotation, double[:, ::1] work, double[:, ::1] out) noexcept
cpdef bint missing_turn(const double[:, :] wanted, const double[:, :] actual, double[::1] out) noexcept
cpdef bint missing_pose(
    const double[:] position, const double[:, :] rotation, const double[:] at, const double[:, :] turned,
    double[::1] out
) noexcept
