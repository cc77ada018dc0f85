# C types of wrench_program.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport pointers as memory

@cython.final
cdef class WrenchProgram:
    cdef double weight
    cdef double length
    cdef double net
    cdef double pressure
    cdef const double[::1] unit
    cdef double[:, ::1] jacobian
    cdef const double[:, ::1] fixed
    cdef double[:, ::1] hessian
    cdef double[::1] wanted
    cdef double[::1] gradient
    cdef double[:, ::1] positions
    cdef double[:, :, ::1] rotations
    cdef double[::1] wished
    cdef double[::1] shares
    cdef double[::1] request
    cdef double[::1] middle

    @cython.locals(
        request="double[::1]", i=Py_ssize_t, share=double, total=double, some=double, fx=double, fy=double, fz=double,
        tx=double, ty=double, tz=double, px=double, py=double, pz=double
    )
    cpdef bint ask(self, wrench, point, shares) except *

    @cython.locals(moved=bint, j=Py_ssize_t, k=Py_ssize_t)
    cpdef bint place(self, Py_ssize_t i, const double[:] position, const double[:, :] rotation) noexcept

    @cython.locals(
        positions="double[:, ::1]", rotations="double[:, :, ::1]", jacobian="double[:, ::1]", middle="double[::1]",
        count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, c=Py_ssize_t, total=double, dx=double, dy=double,
        dz=double, x=double, y=double, z=double
    )
    cpdef bint turn(self) noexcept

    @cython.locals(
        hessian="double[:, ::1]", shares="double[::1]", count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, a=Py_ssize_t,
        b=Py_ssize_t, one=double, other=double
    )
    cpdef bint weigh(self, bint renewed) noexcept

    @cython.locals(
        request="double[::1]", middle="double[::1]", wanted="double[::1]", fx=double, fy=double, fz=double, tx=double,
        ty=double, tz=double, dx=double, dy=double, dz=double, force=double, moment=double
    )
    cpdef void aim(self) noexcept

    @cython.locals(i=Py_ssize_t)
    cpdef void finish_gradient(self) noexcept

    @cython.locals(
        jacobian="double[:, ::1]", wanted="double[::1]", unit="const double[::1]", solution=cython.p_double,
        out=cython.p_double, wrenches=dict, i=Py_ssize_t, j=Py_ssize_t, off=double, largest=double
    )
    cpdef tuple finish(self, unknowns, names)
