# C types of memory.py. Without a compiler this file is not read.
cpdef values(array)
cpdef room(array)
cpdef new_vector(Py_ssize_t size)
cpdef new_matrix(Py_ssize_t rows, Py_ssize_t columns)
