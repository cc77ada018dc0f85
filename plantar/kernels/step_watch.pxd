# C types of step_watch.py. Without a compiler this file is not read.
cimport cython


@cython.final
cdef class StepWatch:
    cdef const double[:] ground
    cdef const double[:] legs
    cdef const double[:] speeds
    cdef double least
    cdef Py_ssize_t airborne
    cdef double slow
    cdef readonly Py_ssize_t now
    cdef Py_ssize_t left
    cdef Py_ssize_t right

    @cython.locals(seen=int, total=double, i=Py_ssize_t)
    cpdef int step(self) noexcept
