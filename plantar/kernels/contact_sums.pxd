# C types of contact_sums.py. Without a compiler this file is not read.
cimport cython

@cython.locals(
    i=Py_ssize_t, x=double, y=double, z=double, a=double, b=double, f=double, fx=double, fy=double, fz=double,
    tx=double, ty=double, tz=double, height=double
)
cpdef ground_sums(
    const double[:, :] positions, const double[:, :] forces, const double[:, :] torques, const double[:] gaps,
    const unsigned char[:] carries, double reach, double[::1] sums, list points
)

@cython.locals(
    i=Py_ssize_t, x=double, y=double, z=double, fx=double, fy=double, fz=double, pairs=dict, pair=list, key=tuple
)
cpdef list pair_loads(
    const int[:] own, const int[:] other, const double[:, :] points, const double[:, :] forces,
    const double[:, :] torques, const double[:] gaps, double reach
)
