cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport order
from . cimport highest_ground

cdef double _INFINITE, _SIGMA_OF_MEDIAN

@cython.final
cdef class GroundSight:
    cdef double[::1] x, y
    cdef double middle_x, middle_y
    cdef double[:, ::1] corners
    cdef double moving, still, halving, least_noise, noise_share, jump, jump_of_all
    cdef Py_ssize_t least
    cdef double steepest
    cdef readonly double[::1] distance, readings
    cdef double[::1] news, work
    cdef unsigned char[::1] used
    cdef double[::1] plane
    cdef double[:, ::1] poses
    cdef Py_ssize_t count, last
    cdef double[::1] rise
    cdef readonly double noise
    cdef double most
    cdef readonly Py_ssize_t seen, on_plane
    cdef readonly double nearest, middle, slope_x, slope_y
    cdef readonly bint found, sloped
    cpdef void begin(self) noexcept
    cpdef void move(self, double time, position, rotation) except *
    cdef void _risen(self, Py_ssize_t pose, const double* p, const double* r) noexcept
    @cython.locals(total=double, news=double, now=double, fresh=Py_ssize_t, known=bint)
    cpdef void mix(self, reading, double time, position, rotation) except *
    @cython.locals(up=double, along=double, aside=double, later=double)
    cdef void _risen_since(self, double time, const double* p, const double* r) noexcept
    @cython.locals(highest=double, seen=Py_ssize_t, on=Py_ssize_t)
    cpdef bint look(self, double bias) except -1
