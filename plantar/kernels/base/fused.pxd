# C types of fused.py. Without a compiler this file is not read.
cpdef multiply_add(a, b, c)
