cimport cython
from ..contacts.foot_contacts cimport ContactsInSole
from ..contacts.foot_contacts cimport FootContacts
from ..contacts.pressed_sole cimport PressedSole
from ..skin.percept_fields cimport ReadingFields
from .noise_rows cimport NoiseRows
from .noise_rows cimport SampleClock
from .noise_rows cimport TaxelSample
from .sole_rays cimport SoleRays

@cython.final
cdef class ProximitySampling:
    cdef NoiseRows noise
    cdef Py_ssize_t count
    cdef const Py_ssize_t[::1] dead
    cdef readonly Py_ssize_t cast, skipped
    cpdef int skip(self) except -1
    cpdef int leave(self) except -1
    cpdef of(self, SoleRays rays)

@cython.final
cdef class SoleSampling:
    cdef SampleClock clock
    cdef TaxelSample sample
    cdef PressedSole sole
    cdef ContactsInSole seen
    cdef double reach
    cdef ProximitySampling proximity
    cdef object queue, kind
    @cython.locals(reading=ReadingFields)
    cpdef read(self, double now, FootContacts contacts, SoleRays rays)
