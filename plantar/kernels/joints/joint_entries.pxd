# C types of joint_entries.py. Without a compiler this file is not read.
cimport cython

@cython.final
cdef class JointEntries:
    cdef const double[::1] vector
    cdef const Py_ssize_t[::1] places
    cdef double[::1] entries

    @cython.locals(k=Py_ssize_t)
    cpdef void take(self) noexcept
