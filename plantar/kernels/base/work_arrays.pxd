# C types of work_arrays.py. Without a compiler this file is not read.
cpdef numbers(Py_ssize_t size, bint lists)
cpdef places(Py_ssize_t size, bint lists)
