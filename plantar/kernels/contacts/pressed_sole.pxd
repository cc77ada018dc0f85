cimport cython
from . cimport pressed_patch
from .foot_contacts cimport ContactsInSole
from .foot_contacts cimport FootContacts
from .pressed_patch cimport PressedPatch

cdef int _RECENT

@cython.final
cdef class PressedSole:
    cdef const double[::1] gains
    cdef double grid
    cdef Py_ssize_t most
    cdef object make
    cdef readonly dict made
    cdef object carried
    cdef readonly double[::1] forces
    cdef double[::1] part
    cdef list recent
    cdef Py_ssize_t[::1] recent_counts
    cdef int slot
    cdef Py_ssize_t room
    cdef double[:, ::1] points
    cdef double[:, :, ::1] places
    cdef _make_room(self, Py_ssize_t room)
    cpdef press(self, FootContacts contacts, const double[:, ::1] vectors, double reach)
    cpdef int stand(self, FootContacts contacts, ContactsInSole seen, double reach) except -1
    @cython.locals(force=double, about_x=double, about_y=double)
    cpdef int load(self, FootContacts contacts, const double[:, ::1] vectors, double reach) except -1
    cdef void _clear(self) noexcept
    @cython.locals(px=double, py=double)
    cpdef spread(self, points, double force, double x, double y)
    cdef int _spread(self, Py_ssize_t count, double force, double x, double y) except -1
    cdef PressedPatch _patch(self, Py_ssize_t count)
    cdef bint _is_recent(self, Py_ssize_t slot, Py_ssize_t count) noexcept
