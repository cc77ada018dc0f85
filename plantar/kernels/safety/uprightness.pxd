cimport cython
from ..base cimport pointers as memory

cdef double _SPIN, _LEAST, _MOST, _NEAR_LOW, _NEAR_HIGH, _DRAWN, _ALONE

@cython.final
cdef class Uprightness:
    cdef double period, gravity, least_turned, least_pulled
    cdef int frozen
    cdef bint begun
    cdef double x, y, z, ax, ay, az
    cdef readonly double turned, pulled
    cdef readonly bint turns, pulls
    cdef double gyro_x, gyro_y, gyro_z, force_x, force_y, force_z
    cdef int gyro_same, force_same
    @cython.locals(turns=bint, pulls=bint, size=double)
    cpdef int update(self, gyro, accelerometer) except -1
    @cython.locals(wx=double, wy=double, wz=double, same=bint, spin=double, x=double, y=double, z=double, dt=double)
    cdef bint _turn(self, double* w) noexcept
    @cython.locals(x=double, y=double, z=double, same=bint, size=double, share=double)
    cdef bint _pull(self, double* a, bint turns) noexcept
