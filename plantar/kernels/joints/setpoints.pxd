cimport cython
from ..base cimport pointers as memory

@cython.final
cdef class Setpoints:
    cdef double[:] controls
    cdef const Py_ssize_t[::1] servos
    cdef const double[::1] stiffness, damping, per_way
    cdef double period, step, share, left
    cdef const double[::1] joints, torques
    cdef readonly double[::1] reference, velocity, goal, setpoint
    cdef double[::1] rate, between, behind
    cpdef void hold(self, const double[:] joints, const double[:] torques) noexcept
    cpdef void go_to(self) noexcept
    @cython.locals(fastest=double, total=double, late=bint)
    cdef void _go_on(self, Py_ssize_t begin, Py_ssize_t end) noexcept
    cpdef void load(self, const double[:] friction=*, offsets=*) except *
    cpdef void write(self) noexcept
    cpdef void advance(self) noexcept
    cpdef void drive(self) noexcept
