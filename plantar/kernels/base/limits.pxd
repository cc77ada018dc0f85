cimport cython
from . cimport pointers as memory

cpdef bint are_plane_points(value, double limit) except *
cpdef pair_of(value)
cpdef bint points_within(const double[:, :] points, double limit)
cpdef bint values_within(const double[:] values, double limit)
