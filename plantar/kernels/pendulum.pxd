# C types of pendulum.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

@cython.locals(axis=Py_ssize_t, grown=double, shrunk=double, vrp=double, growing=double, shrinking=double)
cpdef void on_segment(
    double omega, double since, double until, const double[:] start, const double[:] rate, const double[:] growth,
    const double[:] shrinkage, double[:, ::1] out
) noexcept
