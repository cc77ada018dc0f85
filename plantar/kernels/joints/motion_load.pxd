cimport cython
from ..base cimport pointers as memory

@cython.final
cdef class MotionLoad:
    cdef double[::1] velocity, acceleration
    cdef const double[::1] gravity
    cdef const Py_ssize_t[::1] rows
    cdef const double[::1] load, position, rotation, com
    cdef const double[:, ::1] axes
    cdef const Py_ssize_t[::1] joints
    cdef const double[::1] armature
    cdef double[::1] torques
    cpdef void move(self, velocity, acceleration) except *
    @cython.locals(carried=double, taken=double, about=double)
    cpdef void add(self, acceleration, double left, double couple_x, double couple_y, bint whole) except *

@cython.final
cdef class JointMotion:
    cdef const double[::1] moved
    cdef const Py_ssize_t[::1] rows
    cdef double period, share
    cdef readonly object velocity, acceleration
    @cython.locals(speed=double)
    cpdef void update(self) except *
