cimport cython
from libc cimport math

cdef double _LEAST

@cython.final
cdef class Configuration:
    cdef const Py_ssize_t[::1] ways, speeds, turns, rates
    cdef double[::1] configuration
    cdef const double[::1] velocity
    cpdef void move(self) noexcept
    @cython.locals(w=double, x=double, y=double, z=double, i=double, j=double, k=double)
    cdef void _turn(self, Py_ssize_t place, Py_ssize_t rate) noexcept
