# What fused.py does, for compiled kernels: a kernel imports fused, and its .pxd cimports this file under that name.
# Without a compiler this file is not read.
from libc cimport math

cdef inline double multiply_add(double a, double b, double c) noexcept nogil:
    return math.fma(a, b, c)
