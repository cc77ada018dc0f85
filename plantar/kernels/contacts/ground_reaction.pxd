# C types of ground_reaction.py. Without a compiler this file is not read.
cimport cython
from ..geometry cimport few_points
from ..geometry.few_points cimport FewPoints
from .foot_contacts cimport FootContacts

cdef double _NONE

@cython.final
cdef class GroundReaction:
    cdef double height
    cdef double least
    cdef double reach
    cdef const unsigned char[::1] ground
    cdef readonly double[::1] loads
    cdef double[::1] sums
    cdef FewPoints support
    cdef FewPoints sole
    cdef list ends
    cdef readonly bint found
    cdef readonly double x
    cdef readonly double y
    cdef readonly double margin

    @cython.locals(i=Py_ssize_t, foot=FootContacts, number=Py_ssize_t, before=double)
    cpdef int update(self, feet) except -1

    @cython.locals(force=double, height=double)
    cdef void _find_zmp(self) noexcept

    @cython.locals(first=Py_ssize_t, end=Py_ssize_t)
    cpdef double area(self, Py_ssize_t foot) except? -1.0

    @cython.locals(points=list, foot=Py_ssize_t, ring=list)
    cpdef tuple found_now(self)
