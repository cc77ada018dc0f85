cimport cython

@cython.final
cdef class NoiseRows:
    cdef object draw, drawn
    cdef readonly const double[:, ::1] rows
    cdef Py_ssize_t row
    cpdef Py_ssize_t advance(self) except -1
