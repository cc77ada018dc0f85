# C types of stance_force.py. Without a compiler this file is not read.
cimport cython
from ..contacts.ground_reaction cimport GroundReaction


@cython.final
cdef class StanceForce:
    cdef GroundReaction reaction
    cdef const double[::1] center
    cdef double mass
    cdef double gravity
    cdef Py_ssize_t span
    cdef Py_ssize_t settling
    cdef double scale
    cdef double least
    cdef double edge
    cdef Py_ssize_t size
    cdef double[::1] heights
    cdef double[::1] forces
    cdef Py_ssize_t now
    cdef Py_ssize_t lasting
    cdef readonly Py_ssize_t compared
    cdef readonly double squares
    cdef readonly Py_ssize_t single
    cdef readonly Py_ssize_t at_edge

    @cython.locals(
        left=double, right=double, place=Py_ssize_t, first=Py_ssize_t, middle=Py_ssize_t, bend=double, off=double
    )
    cpdef void step(self, Py_ssize_t since) noexcept
