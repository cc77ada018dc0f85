cimport cython

@cython.final
cdef class SwingLag:
    cdef double period, least, square, product, speed, error
    cdef double[::1] commands
    cdef Py_ssize_t count
    cdef readonly double time, to_come
    cpdef void begin(self) noexcept
    @cython.locals(
        longest=Py_ssize_t, speed=double, off=double, error=double, ticks=double, whole=Py_ssize_t, last=Py_ssize_t,
        before=double
    )
    cpdef void update(self, double commanded, double measured) noexcept
