# C types of foot_contacts.py. Without a compiler this file is not read.
cimport cython
from ..geometry.few_points cimport FewPoints


@cython.final
cdef class ContactList:
    cdef const int[:, :] geoms
    cdef const double[:, :] positions
    cdef const double[:, :] frames
    cdef const double[:] gaps
    cdef const int[:] addresses
    cdef const int[:] sizes
    cdef bint pyramid
    cdef const double[:, :] friction


@cython.locals(foot=FootContacts)
cpdef int gather_feet(tuple feet, ContactList listed, const double[:] forces) except -1


@cython.final
cdef class FootContacts:
    cdef const unsigned char[::1] own
    cdef readonly Py_ssize_t size
    cdef Py_ssize_t room
    cdef readonly int[:, ::1] ids
    cdef readonly double[:, ::1] vectors
    cdef readonly double[::1] gaps
    cdef readonly unsigned char[::1] carries

    cdef int _make_room(self, Py_ssize_t room) except -1

    cpdef void clear(self) noexcept

    @cython.locals(count=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t)
    cpdef take(
        self, const int[:, :] ids, const double[:, :] vectors, const double[:] gaps, const unsigned char[:] carries
    )

    @cython.locals(
        count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, m=Py_ssize_t, first=int, second=int, a=bint, b=bint,
        sign=double, start=Py_ssize_t, row=Py_ssize_t, half=Py_ssize_t, axis=Py_ssize_t, value=double
    )
    cpdef int gather(self, ContactList listed, const double[:] forces) except -1

    @cython.locals(k=Py_ssize_t, row=Py_ssize_t, j=Py_ssize_t)
    cpdef void from_origin(self, const double[:] origin, double[:, ::1] out) noexcept

    @cython.locals(
        k=Py_ssize_t, row=Py_ssize_t, x=double, y=double, z=double, a=double, b=double, f=double, fx=double, fy=double,
        fz=double, tx=double, ty=double, tz=double, height=double
    )
    cpdef int add_to_ground(
        self, double reach, const unsigned char[::1] ground, double[::1] sums, FewPoints points
    ) except -1

    @cython.locals(
        k=Py_ssize_t, row=Py_ssize_t, x=double, y=double, z=double, fx=double, fy=double, fz=double, pairs=dict,
        pair=list, key=tuple
    )
    cpdef list pair_loads(self, const double[:, ::1] vectors, double reach)


@cython.locals(start=Py_ssize_t, size=int, edge=Py_ssize_t, value=double, k=int)
cdef double _along(ContactList listed, const double[:] forces, Py_ssize_t i, Py_ssize_t m) noexcept
