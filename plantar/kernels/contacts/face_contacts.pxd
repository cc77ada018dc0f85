cimport cython
from libc cimport math
from ..base cimport addresses_in_c as addresses, pointers as memory

cdef double _SAME, _TILTED

@cython.final
cdef class FaceContacts:
    cdef size_t stride
    cdef readonly Py_ssize_t count
    cdef object from_memory, cut_memory, turn_memory, shift_memory
    cdef double* corners
    cdef double* cut
    cdef double* turn
    cdef double* shift
    @cython.locals(best=double, reach=double, overlap=double, along=double, side=double)
    cpdef Py_ssize_t box(
        self, size_t places, size_t turns, size_t sizes, Py_ssize_t ground, Py_ssize_t sole, double margin, size_t out,
        double sign
    ) except *
    @cython.locals(side=double)
    cpdef Py_ssize_t cylinder(
        self, size_t places, size_t turns, size_t sizes, Py_ssize_t ground, Py_ssize_t sole, double margin, size_t out,
        double sign
    ) except *
    cdef void _look(self, double* base, double* rows, Py_ssize_t ground, Py_ssize_t sole) noexcept
    cdef void _place_face(self, double* half, Py_ssize_t s, Py_ssize_t axis, double height, double side) noexcept
    @cython.locals(apart=double)
    cdef Py_ssize_t _cut_by(self, Py_ssize_t count, Py_ssize_t axis, double reach) noexcept
    cdef Py_ssize_t _write(
        self, double* base, double* rows, Py_ssize_t ground, Py_ssize_t count, Py_ssize_t axis, double side,
        double height, double margin, size_t out, double sign
    ) noexcept
    cdef void _write_one(
        self, double* base, double* rows, Py_ssize_t ground, Py_ssize_t k, Py_ssize_t axis, double side, double height,
        size_t address, double sign
    ) noexcept
    @cython.locals(da=double, db=double)
    cdef Py_ssize_t _write_disc(
        self, double* base, double* rows, Py_ssize_t ground, double radius, double height, double depth, double side,
        double margin, size_t out, double sign
    ) noexcept
    @cython.locals(best=double, fixed=double)
    cdef bint _furthest(
        self, double ax, double ay, double bx, double by, double mx, double my, double radius, double p, double q,
        double da, double db
    ) noexcept
