# C types of leg_targets.py. Without a compiler this file is not read.
cimport cython

@cython.final
cdef class LegTargets:
    cdef double[::1] com
    cdef double[:, ::1] torso
    cdef double[::1] left
    cdef double[:, ::1] left_turn
    cdef double[::1] right
    cdef double[:, ::1] right_turn

    @cython.locals(
        i=Py_ssize_t, j=Py_ssize_t, c="object[double]", t="object[double, ndim=2]", p="object[double]",
        q="object[double, ndim=2]", r="object[double]", s="object[double, ndim=2]"
    )
    cpdef void take(self, com, torso, left, left_turn, right, right_turn) except *
