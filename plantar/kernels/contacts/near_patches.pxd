cimport cython

@cython.final
cdef class NearPatches:
    cdef const Py_ssize_t[::1] bodies, geoms
    cdef const double[:, ::1] spheres, boxes, shapes
    cdef const double[::1] bounds
    cdef readonly object near
    cdef unsigned char[:, ::1] _near
    cdef double[::1] middle, apart
    @cython.locals(b=Py_ssize_t, g=Py_ssize_t, count=Py_ssize_t, close=bint)
    cpdef Py_ssize_t look(
        self, const double[:, ::1] places, const double[:, ::1] turns, const double[:, ::1] geom_places,
        const double[:, ::1] geom_turns
    )
    @cython.locals(squares=double, local=double, out=double)
    cdef bint _box_is_near(
        self, Py_ssize_t i, Py_ssize_t k, Py_ssize_t g, const double[:, ::1] geom_places,
        const double[:, ::1] geom_turns
    ) noexcept
    @cython.locals(squares=double, local=double, out=double)
    cdef bint _sphere_is_near(
        self, Py_ssize_t i, Py_ssize_t k, Py_ssize_t g, Py_ssize_t b, const double[:, ::1] places,
        const double[:, ::1] turns, const double[:, ::1] geom_places
    ) noexcept
