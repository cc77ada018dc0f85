cpdef multiply_add(a, b, c)
