# C types of step_watch.py. Without a compiler this file is not read.
cimport cython


@cython.final
cdef class StepWatch:
    cdef const double[:] ground
    cdef const double[:] legs
    cdef const double[:] speeds
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] per_speed
    cdef double least
    cdef Py_ssize_t airborne
    cdef const int[:] warnings
    cdef const Py_ssize_t[::1] divergence
    cdef readonly Py_ssize_t now
    cdef public bint awake
    cdef Py_ssize_t left
    cdef Py_ssize_t right

    @cython.locals(seen=int, i=Py_ssize_t)
    cpdef int step(self) noexcept
