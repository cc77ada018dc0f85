cimport cython
from ..base cimport pointers as memory
from ..base cimport order

cdef double _INFINITE, _NONE

@cython.final
cdef class SeenDepth:
    cdef Py_ssize_t least
    cdef double highest, deep, share
    cdef readonly double[::1] depth
    cdef double[::1] work
    cdef readonly Py_ssize_t looks
    cpdef void lift(self) noexcept
    cpdef bint shows(self, double depth) noexcept
    @cython.locals(ground=double, share=double, depth=double, sound=bint)
    cpdef void look(self, distance) except *
