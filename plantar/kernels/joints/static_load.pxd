cimport cython
from ..base cimport pointers as memory

@cython.final
cdef class StaticLoad:
    cdef const Py_ssize_t[::1] parents, bodies
    cdef const double[:, ::1] inertias, motions
    cdef const double[::1] gravity
    cdef const Py_ssize_t[::1] places
    cdef double[::1] torques
    cdef double[:, ::1] wrenches
    cdef readonly double[::1] load
    cpdef void weigh(self) noexcept
    cpdef void less(self, share) except *
    cpdef void take(self) noexcept
