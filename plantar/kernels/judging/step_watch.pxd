# C types of step_watch.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..contacts.ground_reaction cimport GroundReaction
from .joint_extremes cimport JointExtremes
from .stance_force cimport StanceForce
from .stand_watch cimport StandWatch

cdef double _INFINITE
cdef double _ROUNDING


@cython.final
cdef class StepWatch:
    cdef GroundReaction reaction
    cdef StandWatch stands
    cdef JointExtremes joints
    cdef StanceForce stance
    cdef const double[::1] upright
    cdef const double[::1] center
    cdef const double[::1] left
    cdef const double[::1] right
    cdef const double[::1] left_turn
    cdef const double[::1] right_turn
    cdef const double[:] legs
    cdef const int[:] warnings
    cdef const Py_ssize_t[::1] divergence
    cdef double least
    cdef Py_ssize_t airborne
    cdef Py_ssize_t impact_window
    cdef Py_ssize_t area_window
    cdef double tilted
    cdef double lowest
    cdef readonly Py_ssize_t now
    cdef readonly double up
    cdef readonly double margin
    cdef double margin_since
    cdef Py_ssize_t[::1] touched
    cdef Py_ssize_t[::1] landed
    cdef double[::1] impact
    cdef double[::1] area
    cdef list rows
    cdef list last

    @cython.locals(seen=int, foot=Py_ssize_t)
    cpdef int step(self, tuple feet) except -1

    cdef int _land(self, Py_ssize_t foot) except -1

    @cython.locals(foot=Py_ssize_t, number=Py_ssize_t, row=list)
    cdef int _keep(self) except -1

    @cython.locals(row=list)
    cpdef list landings(self)

    @cython.locals(reaction=GroundReaction, foot=Py_ssize_t, force=double, age=Py_ssize_t)
    cdef int _follow(self) except -1

    @cython.locals(seen=int, lower=double, i=Py_ssize_t)
    cdef int _look(self) noexcept

    @cython.locals(force=double)
    cdef int _stand(self, Py_ssize_t foot, const double[::1] place, const double[::1] turn) except -1
