# C types of configuration.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _LEAST

@cython.final
cdef class Configuration:
    cdef const Py_ssize_t[::1] ways
    cdef const Py_ssize_t[::1] speeds
    cdef const Py_ssize_t[::1] turns
    cdef const Py_ssize_t[::1] rates
    cdef double[::1] configuration
    cdef const double[::1] velocity

    @cython.locals(k=Py_ssize_t)
    cpdef void move(self) noexcept

    @cython.locals(
        q="double[::1]", velocity="const double[::1]", w=double, x=double, y=double, z=double, length=double,
        share=double, i=double, j=double, k=double, angle=double, cosine=double, sine=double
    )
    cdef void _turn(self, Py_ssize_t place, Py_ssize_t rate) noexcept
