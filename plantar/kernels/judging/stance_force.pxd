cimport cython
from ..contacts.ground_reaction cimport GroundReaction
from libc cimport math

@cython.final
cdef class StanceForce:
    cdef GroundReaction reaction
    cdef const double[::1] center
    cdef double mass, gravity
    cdef Py_ssize_t span, settling
    cdef double scale, least, edge
    cdef Py_ssize_t size
    cdef double[::1] heights, forces
    cdef Py_ssize_t now, lasting
    cdef readonly Py_ssize_t compared
    cdef readonly double squares
    cdef readonly Py_ssize_t single, at_edge
    cpdef void step(self, Py_ssize_t since) noexcept

@cython.final
cdef class StandWatch:
    cdef readonly double enough
    cdef Py_ssize_t[::1] begun
    cdef unsigned char[::1] stood
    cdef double[:, ::1] first, place
    cdef readonly double slip
    cdef list over
    cpdef int begin(self, Py_ssize_t foot, Py_ssize_t step) except -1
    cdef tuple _row(self, Py_ssize_t foot)
    cpdef list stands(self)
    cpdef void carry(self, Py_ssize_t foot, double force, double x, double y, double yaw) noexcept
