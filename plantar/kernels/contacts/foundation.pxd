cimport cython

@cython.locals(total=double)
cpdef bint spread_whole(
    const double[:, ::1] u, const double[::1] area, const double[:, ::1] inverse, double x, double y, double force,
    const Py_ssize_t[::1] cells, double[::1] out
) noexcept
@cython.locals(
    m00=double, m01=double, m02=double, m11=double, m12=double, m22=double, total=double, pressure=double, carries=bint
)
cpdef bint spread_part(
    const double[:, ::1] u, const double[::1] area, double x, double y, double force, unsigned char[::1] active,
    const Py_ssize_t[::1] cells, double[::1] out
) noexcept
