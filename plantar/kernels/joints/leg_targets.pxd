# C types of leg_targets.py. Without a compiler this file is not read.
cimport cython

from ..base cimport pointers as memory

@cython.final
cdef class LegTargets:
    cdef double[::1] com
    cdef double[:, ::1] torso
    cdef double[::1] left
    cdef double[:, ::1] left_turn
    cdef double[::1] right
    cdef double[:, ::1] right_turn

    @cython.locals(
        i=Py_ssize_t, j=Py_ssize_t, a=cython.p_double, b=cython.p_double, c=cython.p_double, d=cython.p_double,
        e=cython.p_double, f=cython.p_double
    )
    cpdef void take(self, com, torso, left, left_turn, right, right_turn) except *
