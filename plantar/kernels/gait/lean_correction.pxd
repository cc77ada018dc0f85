# C types of lean_correction.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport fused_in_c as fused
from ..base cimport pointers as memory
from ..mechanics cimport rotations

@cython.locals(
    r=cython.p_double, out=cython.p_double, j=Py_ssize_t, angle=double, c=double, s=double, x=double, y=double,
    z=double
)
cpdef object headed(rotation, double yaw)

@cython.locals(
    t=cython.p_double, r=cython.p_double, out=cython.p_double, j=Py_ssize_t, xx=double, xy=double, xz=double,
    yx=double, yy=double, yz=double, zx=double, zy=double, zz=double, x=double, y=double, z=double
)
cpdef object turned(turn, rotation)

@cython.locals(
    p=cython.p_double, q=cython.p_double, c=cython.p_double, e=cython.p_double, k=cython.p_double, by=cython.p_double,
    turned=cython.p_double, dx=double, dy=double, dz=double, xx=double, xy=double, xz=double, yx=double, yy=double,
    yz=double, zx=double, zy=double, zz=double, sx=double, sy=double, sz=double, tx=double, ty=double, tz=double,
    size=double, scale=double
)
cpdef correct(
    position, place, com_command, com_estimated, command, estimated, kept, double largest_shift, double largest_turn,
    double weight, double share, shift, turn
)

cdef (double, double, double, double, double, double, double, double, double) _between(
    const double* a, const double* b
) noexcept
