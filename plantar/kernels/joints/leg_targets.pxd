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
    cpdef void take(self, com, torso, left, left_turn, right, right_turn) except *
    @cython.locals(unloaded=int)
    cpdef int follow(self, command) except -1

@cython.final
cdef class JointEntries:
    cdef const double[::1] vector
    cdef const Py_ssize_t[::1] places
    cdef double[::1] entries
    cpdef void take(self) noexcept
