cimport cython
from ..contacts.contacts_in_sole cimport ContactsInSole
from ..contacts.foot_contacts cimport FootContacts
from .noise_rows cimport NoiseRows
from ..contacts.pressed_sole cimport PressedSole

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
