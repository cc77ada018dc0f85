# C types of foot_contacts.py. Without a compiler this file is not read.
cimport cython
from .few_points cimport FewPoints


@cython.final
cdef class FootContacts:
    cdef const unsigned char[::1] own
    cdef readonly Py_ssize_t size
    cdef Py_ssize_t room
    cdef readonly int[:, ::1] ids
    cdef readonly double[:, ::1] vectors
    cdef readonly double[::1] gaps
    cdef readonly unsigned char[::1] carries
    cdef const int[:, :] all_geoms
    cdef const double[:, :] all_positions
    cdef const double[:, :] all_frames
    cdef const double[:] all_gaps
    cdef const int[:] all_addresses
    cdef const int[:] all_sizes

    cdef _make_room(self, Py_ssize_t room)

    cpdef show(
        self, const int[:, :] geoms, const double[:, :] positions, const double[:, :] frames, const double[:] gaps,
        const int[:] addresses, const int[:] sizes
    )

    cpdef void clear(self) noexcept

    @cython.locals(count=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t)
    cpdef take(
        self, const int[:, :] ids, const double[:, :] vectors, const double[:] gaps, const unsigned char[:] carries
    )

    @cython.locals(
        i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, m=Py_ssize_t, first=int, second=int, a=bint, b=bint, sign=double,
        start=Py_ssize_t, row=Py_ssize_t, half=Py_ssize_t, axis=Py_ssize_t, value=double
    )
    cpdef void gather(self, const double[:] forces) noexcept

    @cython.locals(k=Py_ssize_t, row=Py_ssize_t, j=Py_ssize_t)
    cpdef void from_origin(self, const double[:] origin, double[:, ::1] out) noexcept

    @cython.locals(
        k=Py_ssize_t, row=Py_ssize_t, x=double, y=double, z=double, a=double, b=double, f=double, fx=double, fy=double,
        fz=double, tx=double, ty=double, tz=double, height=double
    )
    cpdef int add_to_ground(self, double reach, double[::1] sums, FewPoints points) except -1

    @cython.locals(
        k=Py_ssize_t, row=Py_ssize_t, x=double, y=double, z=double, fx=double, fy=double, fz=double, pairs=dict,
        pair=list, key=tuple
    )
    cpdef list pair_loads(self, const double[:, ::1] vectors, double reach)
