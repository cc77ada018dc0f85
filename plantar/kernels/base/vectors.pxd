cimport cython
from . cimport pointers as memory

cpdef close(array)
cpdef object kept(array)
cpdef object points_of(const double[:, ::1] room, Py_ssize_t size)
cpdef object vector2(double x, double y)
cpdef object vector(double x, double y, double z)
cpdef object matrix(double xx, double xy, double xz, double yx, double yy, double yz, double zx, double zy, double zz)
