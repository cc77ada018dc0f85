cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport vectors
from ..mechanics cimport rotations
from . cimport gyro_bias
from .push_filter cimport PushFilter

cdef double _NONE

@cython.final
cdef class FloatingBase:
    cdef double omega, period, gravity, averaging, tilt_rate, yaw_rate, bandwidth, minimum_load, astray
    cdef Py_ssize_t samples
    cdef double[:, ::1] rotation
    cdef double[::1] position, com, velocity
    cdef double[:, ::1] places
    cdef double[:, :, ::1] turns
    cdef double[::1] zmp, stood, loads
    cdef unsigned char[::1] pressed
    cdef double[:, ::1] cops
    cdef double[::1] headings, com_in_base
    cdef double[:, :, ::1] places_in_base
    cdef double[:, :, :, ::1] turns_in_base
    cdef double[:, ::1] before, matrix, work
    cdef double[::1] vector, other, rate, specific, planned
    cdef const double[:] com_now, left_now, right_now
    cdef const double[:, :] turn_left_now, turn_right_now
    cdef gyro_bias.GyroBias bias
    cdef gyro_bias.SteadyLoad steady
    cdef PushFilter push
    cdef double leg_share, leg_turning, same_height, anchored
    cdef double[::1] heights
    cpdef void watch(
        self, const double[:] com, const double[:] left, const double[:] right, const double[:, :] turn_left,
        const double[:, :] turn_right
    ) except *
    cpdef void take(self) noexcept
    cpdef void stand(
        self, const double[:, :] rotation, const double[:] position, double heading_left, double heading_right
    ) except *
    cpdef void rest(self) except *
    cpdef void carry(self, Py_ssize_t side, double load, bint pressed, double x, double y) noexcept
    @cython.locals(load=double)
    cpdef double load(self, Py_ssize_t side, double force, double tare, cop) except? -1.0
    @cython.locals(x=double, y=double)
    cpdef step(self, gyro, accelerometer, planned, swing)
    @cython.locals(mu=double)
    cdef double _of_base(self, double planned, double swing) noexcept
    @cython.locals(error=double, total=double, weight=double, z=double, other=double, rise=double)
    cdef void _anchor(self) noexcept
    @cython.locals(x=double, y=double, square=double, turn="double[:, ::1]")
    cpdef int settle(self, accelerometer, planned, swing, felt) except -1
    cpdef follow(
        self, double gyro_x, double gyro_y, double gyro_z, double specific_x, double specific_y, double specific_z,
        double planned_x, double planned_y
    )
    @cython.locals(both=bint)
    cdef void _identify(self, double gyro_x, double gyro_y, double gyro_z) noexcept
    @cython.locals(total=double, x=double, y=double, z=double, sx=double, sy=double, sz=double)
    cpdef bint stand_still(self, double weight_left, double weight_right) noexcept
    cpdef void turn(
        self, const double[:] rate, const double[:] accelerometer, const double[:] planned, bint by_legs,
        const double[:] missed
    ) except *
    @cython.locals(total=double, error=double, x=double, y=double)
    cdef double _heading_error(self) noexcept
    @cython.locals(sx=double, sy=double, sz=double, total=double)
    cpdef void move(self) except *
    cdef void _point(self, Py_ssize_t past, Py_ssize_t side, double x, double y, double[::1] out) noexcept
    @cython.locals(total=double, x=double, y=double)
    cpdef place(self)
    cpdef snapshot(self)
    @cython.locals(acceleration=double)
    cpdef void observe(self, double push_x, double push_y) except *

cdef _vector(const double[::1] v)
cdef _matrix(const double[:, ::1] m)
