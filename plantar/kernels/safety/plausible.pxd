cimport cython
from ..base cimport pointers as memory

cdef double _FAST, _TURNED, _SPIN, _SHOCK

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
    @cython.locals(
        steps=cython.p_double, n=int, i=int, jumped=int, jump=double, value=double, spin=double, shock=double
    )
    cpdef int check(self, joints, gyro, accelerometer) except -1

@cython.final
cdef class SoleCheck:
    cdef double weight
    cdef readonly double left, right
    cdef readonly int left_same, right_same
    cdef bint steady
    cdef readonly bint swapped
    cpdef int update(self, left, int left_count, right, int right_count) except -1

@cython.locals(largest=double, change=double)
cpdef double farthest(before, now, int count) except? -1.0
@cython.locals(total=double)
cdef double _total(double* force, int count) noexcept
