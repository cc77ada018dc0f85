# What addresses.py does, for compiled kernels; it is not compiled itself. Without a compiler this file is not read.
cdef inline double* at(size_t address) noexcept:
    return <double*> address
