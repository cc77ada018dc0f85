# C types of vectors.py. Without a compiler this file is not read.
cimport cython

from . cimport pointers as memory

cpdef close(array)

@cython.locals(size=Py_ssize_t, given=cython.p_double, out=cython.p_double, i=Py_ssize_t)
cpdef object kept(array)

@cython.locals(out=cython.p_double, i=Py_ssize_t)
cpdef object points_of(const double[:, ::1] room, Py_ssize_t size)

@cython.locals(out=cython.p_double)
cpdef object vector2(double x, double y)

@cython.locals(out=cython.p_double)
cpdef object vector(double x, double y, double z)

@cython.locals(out=cython.p_double)
cpdef object matrix(
    double xx, double xy, double xz, double yx, double yy, double yz, double zx, double zy, double zz
)
