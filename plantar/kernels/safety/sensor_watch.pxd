cimport cython
from ..base cimport pointers as memory

from libc cimport math

cdef double _NONE, _INFINITE, _LEAST_PULL, _CARRIES, _MOST_JITTER

@cython.locals(
    load=double, x=double, y=double, xx=double, xy=double, yy=double, f=double, fx=double, fy=double, i=int
)
cdef bint _is_flat(double* positions, double* even, double* force, int count) noexcept

@cython.final
cdef class SensorWatch:
    cdef int joints, window, mean, short, left_count, right_count, stance
    cdef Py_ssize_t ticks
    cdef double mass, gravity, period
    cdef bint walked
    cdef double share, least_acceleration, least_turn, least_load, first_load
    cdef double gyro_noise, encoder_noise, noisy, older
    cdef int readings
    cdef readonly object later, late
    cdef object stamps
    cdef object places, loads, kept, left_positions, right_positions, left_even, right_even
    cdef bint begun
    cdef double normal_x, normal_y, turn_x, turn_y
    cdef double speed_x, speed_y, way_x, way_y, sum_load, sum_pull, sum_gyro, sum_joints
    cdef double largest_acceleration, recent_acceleration, largest_turn, recent_turn, largest_more, recent_more
    cdef double largest_less, recent_less
    cdef readonly double acceleration, turn, load
    @cython.locals(i=int)
    cpdef int restart_clock(self) except -1
    cpdef void skip(self) noexcept
    cpdef void begin_support(self, bint right) noexcept
    cpdef void end_support(self) noexcept
    @cython.locals(found=int, pull=double, time=double, a=cython.p_double, turn=cython.p_double)
    cpdef int update(self, sensors, command, double left_load, double right_load, double reported) except -1
    @cython.locals(
        right=bint, rotation=cython.p_double, x=double, y=double, load=double, positions=cython.p_double,
        even=cython.p_double, count=int
    )
    cpdef int turned(self, sensors, command, double left_load, double right_load) except -1
    @cython.locals(k=int, gap=double)
    cdef int _age(self, int side, double stamp, double time, double reported) except -1
    @cython.locals(n=int, i=int, many=double, spread=double, at=Py_ssize_t, ticks=Py_ssize_t, found=int)
    cdef int _noise(self, double* q, double* w) except -1
    @cython.locals(
        dt=double, window=int, mean=int, size=int, ticks=Py_ssize_t, at=Py_ssize_t, near=Py_ssize_t, far=Py_ssize_t,
        now_x=double, now_y=double, share=double, dx=double, dy=double
    )
    cdef void _accelerate(self, double* x, double* turn, double* a) except *
    @cython.locals(short=int, ticks=Py_ssize_t, at=Py_ssize_t)
    cdef void _weigh(self, double load, double pull) except *
    @cython.locals(found=int, share=double, least=double, more=double)
    cdef int _noticed(self) except -1
