cimport cython
from ..base cimport pointers as memory

from libc cimport math

cdef double _INFINITE, _NONE, _FAST, _TURNED, _SPIN, _SHOCK
cdef int _FEW

cpdef bint are_finite(joints, gyro, accelerometer) except -1
cdef bint _finite(array) except -1
cpdef double away_from_feet(com, left, right) except? -1.0

@cython.final
cdef class BodyCheck:
    cdef int joints, frozen
    cdef bint begun
    cdef readonly int imu_same, joints_same
    cdef object kept
    cdef double slip
    cdef readonly bint slipped
    cdef readonly object slips
    cdef object steps
    cdef readonly int last_slip, jumps
    cdef readonly bint missing
    cdef int gyro_same, force_same, far, passed
    cdef double far_angle
    cdef bint mirrored
    @cython.locals(
        steps=cython.p_double, n=int, i=int, jumped=int, jump=double, value=double, spin=double, shock=double,
        far=int, same=bint, still=bint, passed=int, change=double,
        missing=bint, caught_up=bint
    )
    cpdef int check(self, joints, gyro, accelerometer, int ticks=*) except -1
    cpdef int forget(self, int joint) except -1
    @cython.locals(confirmed=bint)
    cdef bint _has_jumped(self, int joint, double angle, double before) noexcept

@cython.final
cdef class SoleCheck:
    cdef double weight, carried, most
    cdef readonly double left, right
    cdef readonly int left_same, right_same, dead, left_stuck, right_stuck, left_pulls, right_pulls
    cdef int frozen, stuck, pulls, fresh
    cdef double left_readings, right_readings
    cdef object left_kept, right_kept
    cdef bint steady
    cdef readonly bint swapped
    @cython.locals(one=double, other=double)
    cpdef int look(self, left, int left_count, right, int right_count) except -2
    cpdef void skip(self) noexcept
    @cython.locals(new_left=double, new_right=double, old_left=double, old_right=double, near=double, anew=bint)
    cpdef int update(self, left, int left_count, right, int right_count) except -2
    @cython.locals(
        i=int, total=double, value=double, loaded=int, changed=int, stuck=int, which=int, pulling=int, lowest=int,
        least=double
    )
    cdef double _total(self, double* force, int count, double* kept, double readings) noexcept

@cython.final
cdef class TargetMoves:
    cdef double com, foot, turn, force, least
    cdef readonly double height
    cdef object kept
    @cython.locals(near=bint)
    cpdef bint within(self, command) except *
    @cython.locals(lower=double)
    cdef int _rise(self, state) except -1
    @cython.locals(near=bint, i=int)
    cdef bint _near(self, double* kept, int begin, double* now, int count, double most) noexcept
    @cython.locals(i=int, way=double, change=double)
    cdef bint _goes(self, double* kept, int begin, double* now, double most) noexcept
