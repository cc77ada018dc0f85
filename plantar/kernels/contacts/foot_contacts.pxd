cimport cython
from ..base cimport fused_in_c as fused
from ..base cimport pointers as memory
from ..geometry.few_points cimport FewPoints

@cython.final
cdef class ContactList:
    cdef const int[:, :] geoms
    cdef const double[:, :] positions, frames
    cdef const double[:] gaps
    cdef const int[:] addresses, sizes
    cdef bint pyramid
    cdef const double[:, :] friction

@cython.locals(foot=FootContacts, values="const double*")
cpdef int gather_feet(tuple feet, ContactList listed, forces) except -1

@cython.final
cdef class FeetReader:
    cdef object data, options, listed, cone
    cdef readonly tuple feet
    cdef dict lists
    cdef readonly Py_ssize_t count
    @cython.locals(count=Py_ssize_t, foot=FootContacts)
    cpdef tuple read(self)
    @cython.locals(listed=ContactList)
    cpdef ContactList of_present(self, count)

@cython.final
cdef class FootContacts:
    cdef const unsigned char[::1] own
    cdef readonly Py_ssize_t size
    cdef Py_ssize_t room
    cdef readonly int[:, ::1] ids
    cdef readonly double[:, ::1] vectors, normals
    cdef readonly double[::1] gaps
    cdef readonly unsigned char[::1] carries
    cdef int _make_room(self, Py_ssize_t room) except -1
    cpdef void clear(self) noexcept
    cpdef take(
        self, const int[:, :] ids, const double[:, :] vectors, const double[:] gaps, const unsigned char[:] carries
    )
    cpdef int gather(self, ContactList listed, forces) except -1
    @cython.locals(sign=double)
    cdef int _gather(self, ContactList listed, const double* forces) except -1
    cpdef void from_origin(self, const double[:] origin, double[:, ::1] out) noexcept
    @cython.locals(fx=double, fy=double, fz=double, tx=double, ty=double, tz=double, height=double)
    cpdef int add_to_ground(
        self, double reach, const unsigned char[::1] ground, double[::1] sums, FewPoints points
    ) except -1
    @cython.locals(points="double[:, ::1]", force=double, about_x=double, about_y=double)
    cpdef list pair_loads(self, const double[:, ::1] vectors, double reach)
    @cython.locals(force=double, about_x=double, about_y=double)
    cdef (Py_ssize_t, double, double, double) _pair_load(
        self, const double[:, ::1] vectors, double reach, Py_ssize_t k, double[:, ::1] points
    ) noexcept

@cython.locals(value=double)
cdef double _along(ContactList listed, const double* forces, Py_ssize_t i, Py_ssize_t m) noexcept

@cython.final
cdef class ContactsInSole:
    cdef const double[::1] origin
    cdef readonly Py_ssize_t pressed, in_air
    cdef Py_ssize_t room
    cdef double[:, ::1] shifted
    cdef readonly double[:, ::1] vectors, normals
    cdef const double[:, :] axes
    cdef const double[::1] body_place, body_turn, place
    cdef const double[:, ::1] seat
    cdef double[::1] own_origin
    cdef double[:, ::1] own_axes
    cdef bint rides
    cpdef look_from(self, const double[::1] origin, rotation)
    cdef _make_room(self, Py_ssize_t room)
    cpdef ride_on(
        self, const double[::1] body_place, const double[::1] body_turn, const double[::1] place,
        const double[:, ::1] seat, double[::1] origin, double[:, ::1] axes
    )
    @cython.locals(at=double)
    cpdef void look(self) noexcept
    cpdef turn(self, FootContacts contacts)
    cpdef void turn_normals(self, FootContacts contacts) noexcept
