# C types of noise_rows.py. Without a compiler this file is not read.
cimport cython

@cython.final
cdef class NoiseRows:
    cdef object draw
    cdef object drawn
    cdef readonly const double[:, ::1] rows
    cdef Py_ssize_t row

    cpdef Py_ssize_t advance(self) except -1
