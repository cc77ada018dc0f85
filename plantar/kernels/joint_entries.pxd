# C types of joint_entries.py. Without a compiler this file is not read.
cimport cython

from . cimport pointers as memory

@cython.final
cdef class JointEntries:
    cdef double[::1] vector
    cdef const Py_ssize_t[::1] places
    cdef double[::1] entries

    @cython.locals(i=Py_ssize_t, numbers=cython.p_double)
    cpdef void less(self, share) except *

    @cython.locals(k=Py_ssize_t)
    cpdef void take(self) noexcept
