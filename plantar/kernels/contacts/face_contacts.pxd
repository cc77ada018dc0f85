cimport cython
from libc cimport math

from ..base cimport addresses_in_c as addresses, pointers as memory

cdef double _SAME
cdef double _TILTED

@cython.final
cdef class FaceContacts:
    cdef size_t stride
    cdef readonly Py_ssize_t count
    cdef object from_memory, cut_memory, turn_memory, shift_memory
    cdef double* corners
    cdef double* cut
    cdef double* turn
    cdef double* shift

    @cython.locals(
        base=cython.p_double, rows=cython.p_double, half=cython.p_double, turn=cython.p_double, shift=cython.p_double,
        g=Py_ssize_t, s=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, axis=Py_ssize_t, own=Py_ssize_t, count=Py_ssize_t,
        best=double, reach=double, overlap=double, along=double, side=double
    )
    cpdef Py_ssize_t box(
        self, size_t places, size_t turns, size_t sizes, Py_ssize_t ground, Py_ssize_t sole, double margin, size_t out,
        double sign
    ) except *

    @cython.locals(
        base=cython.p_double, rows=cython.p_double, half=cython.p_double, turn=cython.p_double, shift=cython.p_double,
        s=Py_ssize_t, j=Py_ssize_t, own=Py_ssize_t, radius=double, height=double, reach=double, along=double,
        side=double
    )
    cpdef Py_ssize_t cylinder(
        self, size_t places, size_t turns, size_t sizes, Py_ssize_t ground, Py_ssize_t sole, double margin, size_t out,
        double sign
    ) except *

    @cython.locals(g=Py_ssize_t, s=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t)
    cdef void _look(self, double* base, double* rows, Py_ssize_t ground, Py_ssize_t sole) noexcept

    @cython.locals(
        own=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, facing=double, u=double,
        v=double
    )
    cdef void _place_face(self, double* half, Py_ssize_t s, Py_ssize_t axis, double height, double side) noexcept

    @cython.locals(
        side=double, kept=Py_ssize_t, k=Py_ssize_t, n=Py_ssize_t, i=Py_ssize_t, before=Py_ssize_t, here=double,
        there=double, share=double, apart=double
    )
    cdef Py_ssize_t _cut_by(self, Py_ssize_t count, Py_ssize_t axis, double reach) noexcept

    @cython.locals(found=Py_ssize_t, k=Py_ssize_t)
    cdef Py_ssize_t _write(
        self, double* base, double* rows, Py_ssize_t ground, Py_ssize_t count, Py_ssize_t axis, double side,
        double height, double margin, size_t out, double sign
    ) noexcept

    @cython.locals(
        to=cython.p_double, gap=double, g=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, place=double, at=double
    )
    cdef void _write_one(
        self, double* base, double* rows, Py_ssize_t ground, Py_ssize_t k, Py_ssize_t axis, double side, double height,
        size_t address, double sign
    ) noexcept

    @cython.locals(
        ax=double, ay=double, az=double, bx=double, by=double, bz=double, mx=double, my=double, mz=double, size=double,
        p=double, q=double, nearest=double, nx=double, ny=double, found=Py_ssize_t, k=Py_ssize_t, da=double, db=double, u=double, v=double,
        gap=double
    )
    cdef Py_ssize_t _write_disc(
        self, double* base, double* rows, Py_ssize_t ground, double radius, double height, double depth, double side,
        double margin, size_t out, double sign
    ) noexcept

    @cython.locals(
        la=double, lb=double, wx=double, wy=double, size=double, area=double, best=double, u=double, v=double,
        x=double, y=double, k=Py_ssize_t, fixed=double, ox=double, oy=double, ex=double, ey=double, a=double,
        b=double, c=double, root=double, way=double, t=double, along=double
    )
    cdef bint _furthest(
        self, double ax, double ay, double bx, double by, double mx, double my, double radius, double p, double q,
        double da, double db
    ) noexcept
