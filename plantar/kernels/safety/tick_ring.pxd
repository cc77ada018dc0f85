cimport cython
from ..base cimport pointers as memory

cdef double _NONE

@cython.final
cdef class TickRing:
    cdef readonly tuple sizes
    cdef Py_ssize_t width
    cdef readonly object rows
    cdef object numbers
    cdef Py_ssize_t most
    cdef readonly Py_ssize_t count
    @cython.locals(into=Py_ssize_t, size=Py_ssize_t)
    cpdef int add(self, double time, double first, double second, double third, tuple fields) except -1
    cpdef int add_tick(self, double time, sensors, command) except -1
    cpdef object kept(self)

cdef object _force(object readings, object side)

cdef object _numbers(object field, Py_ssize_t size)
