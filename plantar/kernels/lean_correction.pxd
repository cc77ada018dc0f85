# C types of lean_correction.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from . cimport rotations

@cython.locals(
    dx=double, dy=double, dz=double, xx=double, xy=double, xz=double, yx=double, yy=double, yz=double,
    zx=double, zy=double, zz=double, sx=double, sy=double, sz=double, tx=double, ty=double, tz=double, size=double,
    scale=double
)
cpdef void correct(
    const double[:] position, const double[:] place, const double[:] com_command, const double[:] com_estimated,
    const double[:, :] command, const double[:, :] estimated, const double[:] kept, double largest_shift,
    double largest_turn, double weight, double share, double[::1] shift, double[::1] turn
) noexcept
