cimport cython
from ..geometry cimport few_points
from ..geometry.few_points cimport FewPoints
from .foot_contacts cimport FootContacts

cdef double _NONE

@cython.final
cdef class GroundReaction:
    cdef double height, least, reach
    cdef const unsigned char[::1] ground
    cdef readonly double[::1] loads
    cdef double[::1] sums
    cdef FewPoints support, sole
    cdef Py_ssize_t[::1] ends
    cdef Py_ssize_t feet
    cdef readonly bint found
    cdef readonly double x, y, margin
    @cython.locals(foot=FootContacts, number=Py_ssize_t)
    cpdef int update(self, feet) except -1
    cdef void _find_zmp(self) noexcept
    @cython.locals(first=Py_ssize_t, end=Py_ssize_t)
    cpdef double area(self, Py_ssize_t foot) except? -1.0
    cpdef tuple found_now(self)
