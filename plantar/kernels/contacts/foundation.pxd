cimport cython

@cython.locals(i=Py_ssize_t, a=double, b=double, c=double, total=double, pressure=double)
cpdef bint spread_whole(
    const double[:, ::1] u, const double[::1] area, const double[:, ::1] inverse, double x, double y, double force,
    const Py_ssize_t[::1] cells, double[::1] out
) noexcept

@cython.locals(
    i=Py_ssize_t, _=Py_ssize_t, count=Py_ssize_t, m00=double, m01=double, m02=double, m11=double, m12=double, m22=double,
    w=double, p=double, q=double, ridge=double, i00=double, i01=double, i02=double, i11=double, i12=double, i22=double,
    determinant=double, a=double, b=double, c=double, total=double, pressure=double, same=bint, some=bint, carries=bint
)
cpdef bint spread_part(
    const double[:, ::1] u, const double[::1] area, double x, double y, double force, unsigned char[::1] active,
    const Py_ssize_t[::1] cells, double[::1] out
) noexcept
