cimport cython
from libc cimport math
from ..contacts.ground_reaction cimport GroundReaction
from ..contacts.foot_contacts cimport FootContacts
from .applied_forces cimport AppliedForces
from .joint_extremes cimport JointExtremes
from .stance_force cimport StanceForce
from .stance_force cimport StandWatch

cdef double _INFINITE, _ROUNDING

@cython.final
cdef class StepWatch:
    cdef GroundReaction reaction
    cdef StandWatch stands
    cdef JointExtremes joints
    cdef StanceForce stance
    cdef AppliedForces forces
    cdef const double[::1] upright, center, left, right, left_turn, right_turn
    cdef const double[:] legs
    cdef const int[:] warnings
    cdef const Py_ssize_t[::1] divergence
    cdef double least
    cdef Py_ssize_t airborne, impact_window, area_window
    cdef double tilted, lowest
    cdef readonly Py_ssize_t now
    cdef readonly double up, margin
    cdef double margin_since
    cdef Py_ssize_t[::1] touched, landed
    cdef double[::1] impact, area
    cdef list rows, last
    @cython.locals(foot=Py_ssize_t, touching=FootContacts)
    cpdef int step(self, tuple feet, Py_ssize_t contacts) except -1
    cdef int _land(self, Py_ssize_t foot) except -1
    @cython.locals(number=Py_ssize_t)
    cdef int _keep(self) except -1
    cpdef list landings(self)
    cdef int _follow(self) except -1
    cdef int _look(self) noexcept
    cdef int _stand(self, Py_ssize_t foot, const double[::1] place, const double[::1] turn) except -1
