cpdef numbers(Py_ssize_t size, bint lists)
cpdef places(Py_ssize_t size, bint lists)
