# C types of limits.py. Without a compiler this file is not read.
cimport cython

@cython.locals(i=Py_ssize_t, j=Py_ssize_t)
cpdef bint points_within(const double[:, :] points, double limit)

@cython.locals(i=Py_ssize_t)
cpdef bint values_within(const double[:] values, double limit)
