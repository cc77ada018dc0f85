# C types of swing_fit.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

@cython.locals(
    n=Py_ssize_t, m=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, axes=Py_ssize_t, axis=Py_ssize_t,
    s=double, power=double, total=double, left=double
)
cpdef void fit(
    Py_ssize_t order, double now, double before, double earlier, const double[:, ::1] conditions,
    const double[:, ::1] same, const double[:, ::1] high, double pull, const double[::1] way, double[:, ::1] work,
    double[:, ::1] out
) except *
