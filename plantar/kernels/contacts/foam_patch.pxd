cimport cython
from libc cimport math

@cython.final
cdef class FoamPatch:
    cdef const double[:, ::1] starts, ways, limits
    cdef const double[::1] areas, foam
    cdef readonly object origins, rays, wrench
    cdef double[:, ::1] _origins, _rays
    cdef double[::1] _wrench, turn, origin
    @cython.locals(x=double, y=double, z=double)
    cpdef void place(self, const double[::1] turn, const double[::1] origin)
    @cython.locals(wrench="double[::1]", pressed=bint, length=double, distance=double)
    cpdef bint press(
        self, const double[:] lengths, const double[::1] link, const double[::1] obstacle, double[::1] near,
        double[:, :] values, double[:, ::1] vectors
    )
    @cython.locals(
        nx=double, ny=double, nz=double, x=double, y=double, z=double, rate=double, force=double, drag=double,
        vx=double, vy=double, vz=double, fx=double, fy=double, fz=double
    )
    cdef void _yield(
        self, Py_ssize_t i, double length, double depth, const double[::1] link, const double[::1] obstacle,
        double[:, :] values, double[:, ::1] vectors
    ) noexcept
    @cython.locals(f="double[::1]")
    cpdef void add(self, double[::1] row, const double[::1] place, double sign)
    @cython.locals(f="double[::1]", p="double[::1]", mx=double, my=double, mz=double)
    cpdef void add_to_link(self, double[::1] row)
