cimport cython
from libc cimport math

@cython.locals(power=double, total=double)
cpdef void fit(
    Py_ssize_t order, double now, double before, const double[:, ::1] conditions,
    const double[:, ::1] same, const double[:, ::1] high, double pull, const double[::1] way, double[:, ::1] work,
    double[:, ::1] out
) except *
