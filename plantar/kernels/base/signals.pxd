# C types of signals.py. Without a compiler this file is not read.
cpdef int PyErr_CheckSignals() except -1
