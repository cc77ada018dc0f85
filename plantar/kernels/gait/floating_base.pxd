# C types of floating_base.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport vectors
from ..mechanics cimport rotations
from . cimport gyro_bias

cdef double _NONE

@cython.final
cdef class FloatingBase:
    cdef double omega
    cdef double period
    cdef double gravity
    cdef double averaging
    cdef double tilt_rate
    cdef double yaw_rate
    cdef double bandwidth
    cdef double minimum_load
    cdef double astray
    cdef Py_ssize_t samples
    cdef double[:, ::1] rotation
    cdef double[::1] position
    cdef double[::1] com
    cdef double[::1] velocity
    cdef double[:, ::1] places
    cdef double[:, :, ::1] turns
    cdef double[::1] zmp
    cdef double[::1] stood
    cdef double[::1] loads
    cdef unsigned char[::1] pressed
    cdef double[:, ::1] cops
    cdef double[::1] headings
    cdef double[::1] com_in_base
    cdef double[:, :, ::1] places_in_base
    cdef double[:, :, :, ::1] turns_in_base
    cdef double[:, ::1] before
    cdef double[:, ::1] matrix
    cdef double[:, ::1] work
    cdef double[::1] vector
    cdef double[::1] other
    cdef double[::1] rate
    cdef double[::1] specific
    cdef double[::1] planned
    cdef const double[:] com_now
    cdef const double[:] left_now
    cdef const double[:] right_now
    cdef const double[:, :] turn_left_now
    cdef const double[:, :] turn_right_now
    cdef gyro_bias.GyroBias bias
    cdef gyro_bias.SteadyLoad steady

    cpdef void watch(
        self, const double[:] com, const double[:] left, const double[:] right, const double[:, :] turn_left,
        const double[:, :] turn_right
    ) except *

    @cython.locals(
        i=Py_ssize_t, j=Py_ssize_t, side=Py_ssize_t, places="double[:, :, ::1]", turns="double[:, :, :, ::1]",
        com="const double[:]", left="const double[:]", right="const double[:]", turn_left="const double[:, :]",
        turn_right="const double[:, :]"
    )
    cpdef void take(self) noexcept

    @cython.locals(i=Py_ssize_t, j=Py_ssize_t)
    cpdef void stand(
        self, const double[:, :] rotation, const double[:] position, double heading_left, double heading_right
    ) except *

    cpdef void rest(self) except *

    cpdef void carry(self, Py_ssize_t side, double load, bint pressed, double x, double y) noexcept

    @cython.locals(i=Py_ssize_t, rate="double[::1]", bias=gyro_bias.GyroBias)
    cpdef follow(
        self, double gyro_x, double gyro_y, double gyro_z, double specific_x, double specific_y, double specific_z,
        double planned_x, double planned_y
    )

    @cython.locals(
        left=double, right=double, stands=bint, both=bint, steady=gyro_bias.SteadyLoad, stood="double[::1]"
    )
    cdef void _identify(self, double gyro_x, double gyro_y, double gyro_z) noexcept

    @cython.locals(
        side=Py_ssize_t, k=Py_ssize_t, turns="double[:, :, :, ::1]", stood="double[::1]", weight=double, total=double,
        x=double, y=double, z=double, sx=double, sy=double, sz=double
    )
    cpdef bint stand_still(self, double weight_left, double weight_right) noexcept

    @cython.locals(
        i=Py_ssize_t, j=Py_ssize_t, rotation="double[:, ::1]", before="double[:, ::1]", specific="double[::1]",
        vector="double[::1]", rx=double, ry=double, rz=double, x=double, y=double, z=double, size=double,
        since=double, gain=double, error=double
    )
    cpdef void turn(
        self, const double[:] rate, const double[:] accelerometer, const double[:] planned, bint by_legs,
        const double[:] missed
    ) except *

    @cython.locals(
        side=Py_ssize_t, k=Py_ssize_t, rotation="double[:, ::1]", headings="double[::1]",
        turns="double[:, :, :, ::1]", total=double, error=double, weight=double, x=double, y=double, yaw=double
    )
    cdef double _heading_error(self) noexcept

    @cython.locals(
        i=Py_ssize_t, side=Py_ssize_t, before="double[:, ::1]", now="double[:, ::1]", vector="double[::1]",
        other="double[::1]", cops="double[:, ::1]", sx=double, sy=double, sz=double, total=double, weight=double
    )
    cpdef void move(self) except *

    @cython.locals(i=Py_ssize_t, places="double[:, :, ::1]", turns="double[:, :, :, ::1]")
    cdef void _point(self, Py_ssize_t past, Py_ssize_t side, double x, double y, double[::1] out) noexcept

    @cython.locals(
        i=Py_ssize_t, k=Py_ssize_t, side=Py_ssize_t, rotation="double[:, ::1]", position="double[::1]",
        places="double[:, ::1]", turns="double[:, :, ::1]", loads="double[::1]", cops="double[:, ::1]", load=double,
        total=double, x=double, y=double
    )
    cpdef place(self)

    @cython.locals(places="double[:, ::1]", turns="double[:, :, ::1]")
    cpdef snapshot(self)

    @cython.locals(
        i=Py_ssize_t, com="double[::1]", velocity="double[::1]", zmp="double[::1]", period=double, near=double,
        fast=double, acceleration=double, error=double
    )
    cpdef void observe(self, double push_x, double push_y) except *


cdef _vector(const double[::1] v)
cdef _matrix(const double[:, ::1] m)
