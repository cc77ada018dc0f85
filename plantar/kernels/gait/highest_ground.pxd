# C types of highest_ground.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _INFINITE
cdef double _TOLERANCE
cdef double _TOLERANCE_OF_MEAN
cdef int _CUTS
cdef int _POLISHES
cdef int _LEAST_POINTS
cdef double _LEAST_SPREAD
cdef double _IN_A_ROW

@cython.locals(
    n=Py_ssize_t, i=Py_ssize_t, _=Py_ssize_t, higher=bint, lower=bint, above=double, off=double, changed=bint,
    near=bint, level=double, sx=double, sy=double, fits=bint, on=Py_ssize_t
)
cpdef bint highest_plane(
    const double[:] x, const double[:] y, const double[:] distance, const double[:] readings, double noise,
    Py_ssize_t least, unsigned char[:] used, double[:] plane
) except -1

cdef double _above(
    const double[:] x, const double[:] y, const double[:] distance, const double[:] plane, Py_ssize_t i
) noexcept

cdef double _explained(double noise, double readings) noexcept

@cython.locals(
    count=Py_ssize_t, whole=double, mx=double, my=double, md=double, i=Py_ssize_t, w=double, xx=double, xy=double,
    yy=double, xd=double, yd=double, u=double, v=double, d=double, determinant=double, sx=double, sy=double, n=Py_ssize_t,
    ax=double, ay=double, axx=double, ayy=double, least=double
)
cdef bint _fit(
    const double[:] x, const double[:] y, const double[:] distance, const double[:] readings,
    const unsigned char[:] used, double[:] plane
) noexcept
