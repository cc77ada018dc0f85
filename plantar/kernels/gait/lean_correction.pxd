cimport cython
from libc cimport math
from ..base cimport fused_in_c as fused
from ..base cimport pointers as memory
from ..mechanics cimport rotations

cpdef object headed(rotation, double yaw)
cpdef object turned(turn, rotation)
@cython.locals(scale=double)
cpdef correct(
    position, place, com_command, com_estimated, command, estimated, kept, double largest_shift, double largest_turn,
    double weight, double share, shift, turn
)
cdef (double, double, double, double, double, double, double, double, double) _between(
    const double* a, const double* b
) noexcept
