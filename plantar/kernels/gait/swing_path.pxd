cimport cython
from libc cimport math
from ..base cimport vectors

cdef double _APPROACH_SHARE, _ARRIVED_SHARE, _RISE_SHARE, _HIGH_SHARE, _FIRST_SHARE, _SKEW

@cython.final
cdef class SwingPath:
    cdef double x, y, z, yaw, to_x, to_y, to_z, turn, top, duration, spare, approach, speed, first
    cdef bint slow
    cdef readonly double lifted, arrived
    @cython.locals(share=double, blend=double)
    cpdef tuple at(self, double time)
    @cython.locals(
        top=double, end=double, lifted=double, rising=double, lasting=double, speed=double, since=double, low=double,
        length=double, s=double, drop=double, pull=double, s3=double
    )
    cdef double _height(self, double time) noexcept

cdef double _eased(double phase) noexcept
