cimport cython
from ..contacts.foot_contacts cimport FootContacts

@cython.final
cdef class PieceLoads:
    cdef const Py_ssize_t[::1] numbers
    cdef double least
    cdef double[::1] loads
    cdef Py_ssize_t[::1] lasting
    cdef readonly double[::1] largest
    cdef readonly Py_ssize_t[::1] longest
    @cython.locals(foot=FootContacts, piece=Py_ssize_t, geom=Py_ssize_t)
    cpdef int step(self, tuple feet) except -1
