# What addresses.py does, for compiled kernels: a kernel imports addresses, and its .pxd cimports this file under that name.
# Without a compiler this file is not read.
cdef inline double* at(size_t address) noexcept:
    return <double*> address
