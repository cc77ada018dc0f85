# C types of reading_fields.py. Without a compiler this file is not read.
cimport cython

from ..base cimport vectors

cdef double _LARGEST

cdef class ReadingFields:
    cdef readonly object time
    cdef readonly object force
    cdef readonly object proximity
    cdef readonly object temperature
    cdef readonly object acceleration

    cdef _fill(self, time, force, proximity, temperature, acceleration)
