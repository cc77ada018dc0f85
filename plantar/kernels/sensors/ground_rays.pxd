cimport cython
from libc cimport math

cdef double _TINY
@cython.locals(x=double, y=double, z=double, spread=double)
cpdef void cast_rays(
    const double[:, :] starts, const double[:, :] ways, double reach, const int[:] ids, const int[:] kinds,
    const double[:, :] sizes, const double[:] bounds, const double[:, :] positions, const double[:, :] frames,
    double[:] lengths
)
cdef double _ray(
    Py_ssize_t k, Py_ssize_t g, Py_ssize_t i, const double[:, :] starts, const double[:, :] ways, const int[:] kinds,
    const double[:, :] sizes, const double[:, :] positions, const double[:, :] frames
) noexcept
cdef double _nearer(double a, double b, double c) noexcept
@cython.locals(inside=bint)
cdef double _plane(double a, double b, double px, double py, double pz, double wx, double wy, double wz) noexcept
@cython.locals(best=double)
cdef double _cylinder(
    double radius, double half, double px, double py, double pz, double wx, double wy, double wz
) noexcept
cdef double _face(
    double p, double q, double r, double wp, double wq, double wr, double half_p, double half_q, double half_r,
    double best
) noexcept
