cimport cython
from .foot_contacts cimport FootContacts

cdef object _dot

@cython.final
cdef class ContactsInSole:
    cdef const double[::1] origin
    cdef object rotation
    cdef readonly Py_ssize_t pressed, in_air
    cdef Py_ssize_t room
    cdef double[:, ::1] shifted
    cdef readonly double[:, ::1] vectors
    cdef list rows, heads
    cpdef look_from(self, const double[::1] origin, rotation)
    cdef _make_room(self, Py_ssize_t room)
    cpdef turn(self, FootContacts contacts)
