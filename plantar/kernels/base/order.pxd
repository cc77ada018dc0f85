cimport cython

cpdef void select(double[::1] numbers, Py_ssize_t count, Py_ssize_t place) noexcept
@cython.locals(below=double)
cpdef double median(double[::1] numbers, Py_ssize_t count) noexcept
@cython.locals(total=double)
cpdef double mean_of_least(double[::1] numbers, Py_ssize_t count, Py_ssize_t least) noexcept
