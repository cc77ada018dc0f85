# C types of limits.py. Without a compiler this file is not read.
cimport cython
from . cimport pointers as memory

@cython.locals(k=Py_ssize_t, i=Py_ssize_t, p=cython.p_double)
cpdef bint are_plane_points(value, double limit) except *

@cython.locals(p=cython.p_double)
cpdef pair_of(value)

@cython.locals(i=Py_ssize_t, j=Py_ssize_t)
cpdef bint points_within(const double[:, :] points, double limit)

@cython.locals(i=Py_ssize_t)
cpdef bint values_within(const double[:] values, double limit)
