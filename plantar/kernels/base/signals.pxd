cpdef int PyErr_CheckSignals() except -1
