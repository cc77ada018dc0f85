cimport cython
from . cimport pointers as memory

cdef class Member:
    cdef readonly object function
    cdef readonly str name

cpdef close_all(value)
