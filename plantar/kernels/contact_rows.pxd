# C types of contact_rows.py. Without a compiler this file is not read.
cimport cython

@cython.locals(
    i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, m=Py_ssize_t, foot=Py_ssize_t, first=int, second=int, a=bint, b=bint,
    sign=double, start=Py_ssize_t, half=Py_ssize_t, axis=Py_ssize_t, value=double
)
cpdef list contact_rows(
    const int[:, :] geoms, const double[:, :] positions, const double[:, :] frames, const double[:] gaps,
    const int[:] addresses, const int[:] sizes, const double[:] forces, const unsigned char[:, ::1] own,
    int[:, ::1] ids, double[:, ::1] rows, unsigned char[::1] carries
)
