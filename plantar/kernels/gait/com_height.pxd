cimport cython

@cython.final
cdef class CoMHeight:
    cdef readonly double ground, rate
    cdef double period, frequency
    cpdef double update(self, double target) except? -1.0
