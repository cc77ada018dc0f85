# C types of plausible.py. Without a compiler this file is not read.
cimport cython
from ..base cimport pointers as memory

cdef double _FAST
cdef double _TURNED
cdef double _SPIN
cdef double _SHOCK

@cython.final
cdef class BodyCheck:
    cdef int joints
    cdef int frozen
    cdef bint begun
    cdef readonly int imu_same
    cdef readonly int joints_same
    cdef object kept
    cdef double slip
    cdef readonly bint slipped
    cdef readonly object slips
    cdef object steps

    @cython.locals(q=cython.p_double, w=cython.p_double, a=cython.p_double, kept=cython.p_double, slips=cython.p_double, steps=cython.p_double, n=int, i=int, jumped=int, jump=double, same=bint, value=double, spin=double, shock=double, found=int)
    cpdef int check(self, joints, gyro, accelerometer) except -1

@cython.final
cdef class SoleCheck:
    cdef double weight
    cdef readonly double left
    cdef readonly double right
    cdef readonly int left_same
    cdef readonly int right_same
    cdef bint steady
    cdef readonly bint swapped

    @cython.locals(new_left=double, new_right=double, old_left=double, old_right=double, near=double)
    cpdef int update(self, left, int left_count, right, int right_count) except -1

@cython.locals(a=cython.p_double, b=cython.p_double, i=int, largest=double, change=double)
cpdef double farthest(before, now, int count) except? -1.0

@cython.locals(i=int, total=double, value=double)
cdef double _total(double* force, int count) noexcept
