# C types of contacts_in_sole.py. Without a compiler this file is not read.
cimport cython
from .foot_contacts cimport FootContacts

cdef object _dot

@cython.final
cdef class ContactsInSole:
    cdef const double[::1] origin
    cdef object rotation
    cdef readonly Py_ssize_t pressed
    cdef readonly Py_ssize_t in_air
    cdef Py_ssize_t room
    cdef double[:, ::1] shifted
    cdef readonly double[:, ::1] vectors
    cdef list rows
    cdef list heads

    cpdef look_from(self, const double[::1] origin, rotation)

    @cython.locals(k=Py_ssize_t)
    cdef _make_room(self, Py_ssize_t room)

    @cython.locals(count=Py_ssize_t)
    cpdef turn(self, FootContacts contacts)
