cimport cython
from ..base cimport pointers as memory

from libc cimport math

@cython.final
cdef class TaxelWatch:
    cdef int taxels, ticks, air_ticks, few
    cdef object starts, neighbours, over, flown, pulled, before
    cdef double most, alone, air
    cdef readonly object out
    cdef readonly int count
    cdef bint was_up, begun
    @cython.locals(changed=bint)
    cpdef bint update(self, force, double spare, bint up, int pulls) except *
    @cython.locals(i=int)
    cdef void _begin(self, int n) except *
    @cython.locals(changed=bint, i=int, j=int, k=int, value=double, largest=double)
    cdef bint _compare(self, double* f, int n, double spare) except *
    cdef bint _pull(self, int i) except *
    @cython.locals(changed=bint, i=int, loaded=int)
    cdef bint _fly(self, double* f, int n) except *
    @cython.locals(changed=bint, i=int)
    cdef bint _land(self, int n) except *
