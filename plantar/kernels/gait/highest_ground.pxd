cimport cython
from libc cimport math

cdef double _INFINITE, _TOLERANCE, _TOLERANCE_OF_MEAN
cdef int _CUTS, _POLISHES, _LEAST_POINTS
cdef double _LEAST_SPREAD, _IN_A_ROW
@cython.locals(higher=bint, lower=bint, near=bint)
cpdef bint highest_plane(
    const double[:] x, const double[:] y, const double[:] distance, const double[:] readings, double noise,
    Py_ssize_t least, unsigned char[:] used, double[:] plane
) except -1
cdef double _above(
    const double[:] x, const double[:] y, const double[:] distance, const double[:] plane, Py_ssize_t i
) noexcept
cdef double _explained(double noise, double readings) noexcept
@cython.locals(
    whole=double, mx=double, my=double, md=double, xx=double, xy=double, yy=double, xd=double, yd=double, ax=double,
    ay=double, axx=double, ayy=double
)
cdef bint _fit(
    const double[:] x, const double[:] y, const double[:] distance, const double[:] readings,
    const unsigned char[:] used, double[:] plane
) noexcept
