cimport cython
from ..contacts.foot_contacts cimport ContactsInSole
from ..contacts.foot_contacts cimport FootContacts
from ..contacts.pressed_sole cimport PressedSole

@cython.final
cdef class NoiseRows:
    cdef object draw, drawn
    cdef readonly const double[:, ::1] rows
    cdef Py_ssize_t row
    cpdef Py_ssize_t advance(self) except -1

@cython.final
cdef class SensedBody:
    cdef const double[::1] positions
    cdef const Py_ssize_t[::1] places
    cdef const double[::1] rate, force
    cdef NoiseRows noise
    cdef const double[::1] offsets, bias
    cdef tuple arrays
    cdef double[::1] told_joints, told_rate, told_force
    cpdef tuple read(self)
    cdef void _take(self, Py_ssize_t row) noexcept

@cython.final
cdef class SampleClock:
    cdef double period, near, start
    cdef long taken
    cpdef int begin(self, double now) except -1
    cpdef bint due(self, double now) noexcept

cdef double _NONE

@cython.final
cdef class TaxelSample:
    cdef NoiseRows noise
    cdef double least, most
    cdef const Py_ssize_t[::1] dead
    cdef object sample
    cdef double[::1] told
    cpdef of(self, const double[:] force)
    cpdef of_contacts(self, PressedSole sole, FootContacts contacts, ContactsInSole seen, double reach)
    cdef void _take(self, const double[:] force, Py_ssize_t row) noexcept
