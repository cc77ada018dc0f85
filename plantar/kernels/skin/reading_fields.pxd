cimport cython
from ..base cimport vectors

cdef double _LARGEST

cdef class ReadingFields:
    cdef readonly object time, force, proximity, temperature, acceleration
    cdef _fill(self, time, force, proximity, temperature, acceleration)
