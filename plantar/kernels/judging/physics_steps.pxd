cimport cython
from ..contacts.foot_contacts cimport FeetReader
from ..joints.setpoints cimport Setpoints
from .piece_loads cimport PieceLoads
from .step_watch cimport StepWatch

@cython.final
cdef class PhysicsSteps:
    cdef Setpoints drives
    cdef object step
    cdef FeetReader contacts
    cdef StepWatch watch
    cdef PieceLoads pieces
    cdef readonly int seen
    @cython.locals(done=Py_ssize_t, feet=tuple)
    cpdef Py_ssize_t advance(self, Py_ssize_t steps) except -1
