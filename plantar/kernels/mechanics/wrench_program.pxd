cimport cython
from libc cimport math
from ..base cimport pointers as memory

@cython.final
cdef class WrenchProgram:
    cdef double weight, length, net, pressure, horizontal
    cdef const double[::1] unit
    cdef double[:, ::1] jacobian
    cdef const double[:, ::1] fixed
    cdef double[:, ::1] hessian
    cdef double[::1] wanted, gradient
    cdef double[:, ::1] positions
    cdef double[:, :, ::1] rotations
    cdef double[::1] wished, shares, request, middle
    cdef double[:, ::1] factor
    cdef bint factored
    @cython.locals(
        share=double, total=double, some=double, fx=double, fy=double, fz=double, tx=double, ty=double, tz=double,
        px=double, py=double, pz=double
    )
    cpdef bint ask(self, wrench, point, shares) except *
    @cython.locals(moved=bint)
    cpdef bint place(self, Py_ssize_t i, const double[:] position, const double[:, :] rotation) noexcept
    @cython.locals(total=double)
    cpdef bint turn(self) noexcept
    cpdef bint weigh(self, bint renewed) noexcept
    @cython.locals(own=double, its=double, both=double)
    cdef void _level(self, Py_ssize_t i, Py_ssize_t j, double cost) noexcept
    cpdef void aim(self) noexcept
    cpdef void finish_gradient(self) noexcept
    @cython.locals(total=double)
    cpdef least_cost(self, const double[:, ::1] constraints, const double[::1] upper)
    @cython.locals(total=double)
    cdef bint _factorise(self) noexcept
    @cython.locals(i=Py_ssize_t, off=double, largest=double)
    cpdef tuple finish(self, unknowns, names)
