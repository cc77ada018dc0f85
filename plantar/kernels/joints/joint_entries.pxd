cimport cython

@cython.final
cdef class JointEntries:
    cdef const double[::1] vector
    cdef const Py_ssize_t[::1] places
    cdef double[::1] entries
    cpdef void take(self) noexcept
