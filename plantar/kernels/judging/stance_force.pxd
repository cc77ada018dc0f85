cimport cython
from ..contacts.ground_reaction cimport GroundReaction

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
