# C types of setpoints.py. Without a compiler this file is not read.
cimport cython

from ..base cimport pointers as memory


@cython.final
cdef class Setpoints:
    cdef double[:] controls
    cdef const Py_ssize_t[::1] servos
    cdef const double[::1] stiffness
    cdef const double[::1] damping
    cdef const double[::1] per_way
    cdef double period
    cdef double step
    cdef double share
    cdef const double[::1] joints
    cdef const double[::1] torques
    cdef readonly double[::1] reference
    cdef readonly double[::1] velocity
    cdef readonly double[::1] goal
    cdef readonly double[::1] setpoint
    cdef double[::1] rate
    cdef double[::1] between

    @cython.locals(i=Py_ssize_t)
    cpdef void hold(self, const double[:] joints, const double[:] torques) noexcept

    @cython.locals(
        joints="const double[::1]", count=Py_ssize_t, i=Py_ssize_t, fastest=double, total=double, share=double,
        late=bint, last=double, goal=double
    )
    cpdef void go_to(self) noexcept

    @cython.locals(i=Py_ssize_t, torque=double, lead=double, angles=cython.p_double)
    cpdef void load(self, const double[:] friction=*, offsets=*) except *

    @cython.locals(i=Py_ssize_t)
    cpdef void write(self) noexcept

    @cython.locals(i=Py_ssize_t)
    cpdef void advance(self) noexcept
    cpdef void drive(self) noexcept
