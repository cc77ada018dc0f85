cimport cython
from ..contacts.ground_reaction cimport GroundReaction

@cython.final
cdef class EstimateError:
    cdef const double[::1] center
    cdef GroundReaction reaction
    cdef readonly double[::1] com
    cdef readonly double squares
    cdef readonly Py_ssize_t compared
    @cython.locals(estimated=double, off=double, x=double, y=double, dx=double, dy=double)
    cpdef int update(self, list com, list zmp) except -1
