cimport cython

cdef double _INFINITE

@cython.final
cdef class SteadyLoad:
    cdef double share, follow, band
    cdef bint begun
    cdef double mean_left, mean_right
    cdef readonly double left, right
    cpdef void update(self, double left, double right) noexcept
    cdef bint _is_still(self, double load, double mean, double nearly_all, double hardly) noexcept

@cython.final
cdef class GyroBias:
    cdef double period, least, largest
    cdef Py_ssize_t most_ticks
    cdef double slip, one_foot, known
    cdef readonly double[::1] value, missed
    cdef readonly bint concluded
    cdef double gathered, x, y, z, worth
    cdef Py_ssize_t ticks
    cdef void _begin(self) noexcept
    cpdef void update(
        self, double gyro_x, double gyro_y, double gyro_z, bint stands, double turn_x, double turn_y, double turn_z,
        bint both
    ) noexcept
    @cython.locals(first=bint, share=double)
    cdef void _conclude(self) noexcept

cdef double _limited(double number, double largest) noexcept
