# C types of rotations.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport vectors

cdef double _SMALL

@cython.locals(i=Py_ssize_t)
cpdef void turn(const double[:, ::1] rotation, const double[::1] vector, double[::1] out) noexcept

@cython.locals(i=Py_ssize_t)
cpdef void turn_back(const double[:, ::1] rotation, const double[::1] vector, double[::1] out) noexcept

@cython.locals(i=Py_ssize_t, j=Py_ssize_t)
cpdef void multiply(const double[:, ::1] a, const double[:, ::1] b, double[:, ::1] out) noexcept

@cython.locals(
    k=Py_ssize_t, xx=double, xy=double, xz=double, yx=double, yy=double, yz=double, zx=double, zy=double, zz=double
)
cpdef (double, double, double, double, double, double, double, double, double) between(
    const double[:, :] a, const double[:, :] b
) noexcept

@cython.locals(
    xx=double, xy=double, xz=double, yx=double, yy=double, yz=double, zx=double, zy=double, zz=double
)
cpdef void exponential(double x, double y, double z, double[:, ::1] out) noexcept

@cython.locals(
    xx=double, xy=double, xz=double, yx=double, yy=double, yz=double, zx=double, zy=double, zz=double
)
cpdef object rotation_of(double x, double y, double z)

@cython.locals(
    angle=double, s=double, c=double, xx=double, yy=double, zz=double, xy=double, xz=double, yz=double
)
cdef (double, double, double, double, double, double, double, double, double) _exponential(
    double x, double y, double z
) noexcept

@cython.locals(i=Py_ssize_t, j=Py_ssize_t, total=double)
cpdef void orthonormalise(const double[:, ::1] rotation, double[:, ::1] work, double[:, ::1] out) noexcept

@cython.locals(
    xx=double, xy=double, xz=double, yx=double, yy=double, yz=double, zx=double, zy=double, zz=double
)
cpdef bint missing_turn(const double[:, :] wanted, const double[:, :] actual, double[::1] out) noexcept

@cython.locals(i=Py_ssize_t)
cpdef bint missing_pose(
    const double[:] position, const double[:, :] rotation, const double[:] at, const double[:, :] turned,
    double[::1] out
) noexcept
