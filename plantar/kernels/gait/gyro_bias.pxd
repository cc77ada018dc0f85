# C types of gyro_bias.py. Without a compiler this file is not read.
cimport cython

cdef double _INFINITE

@cython.final
cdef class SteadyLoad:
    cdef double share
    cdef double follow
    cdef double band
    cdef bint begun
    cdef double mean_left
    cdef double mean_right
    cdef readonly double left
    cdef readonly double right

    @cython.locals(total=double, nearly_all=double, hardly=double)
    cpdef void update(self, double left, double right) noexcept

    cdef bint _is_still(self, double load, double mean, double nearly_all, double hardly) noexcept


@cython.final
cdef class GyroBias:
    cdef double period
    cdef double least
    cdef double largest
    cdef Py_ssize_t most_ticks
    cdef double slip
    cdef double one_foot
    cdef double known
    cdef readonly double[::1] value
    cdef readonly double[::1] missed
    cdef readonly bint concluded
    cdef double gathered
    cdef double x
    cdef double y
    cdef double z
    cdef double worth
    cdef Py_ssize_t ticks

    cdef void _begin(self) noexcept

    cpdef void update(
        self, double gyro_x, double gyro_y, double gyro_z, bint stands, double turn_x, double turn_y, double turn_z,
        bint both
    ) noexcept

    @cython.locals(i=Py_ssize_t, first=bint, duration=double, share=double, beyond=double, allowed=double)
    cdef void _conclude(self) noexcept


cdef double _limited(double number, double largest) noexcept
