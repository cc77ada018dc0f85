cimport cython
from libc cimport math
from .foot_contacts cimport ContactsInSole
from .foot_contacts cimport FootContacts
from . cimport pressed_patch
from ..geometry cimport convex

cdef double _SPREAD, _FAINT, _EXACT

@cython.final
cdef class TaxelLoad:
    cdef const double[:, ::1] positions, normals
    cdef const double[::1] areas, widths
    cdef const double[:, ::1] hull
    cdef bint level
    cdef double inner
    cdef readonly object block, vectors, forces, depths, wrench
    cdef double[:, ::1] _vectors
    cdef double[::1] middle, _forces, _depths, _wrench, weights, prior, normal, gaps
    cdef readonly bint carried
    cdef Py_ssize_t room
    cdef double[:, ::1] points, ring, edges, rows, sums
    cdef int _make_room(self, Py_ssize_t room) except -1
    cpdef bint is_lost(self) noexcept
    cpdef press(self, FootContacts contacts, ContactsInSole seen, double reach)
    @cython.locals(sums="double[:, ::1]")
    cdef bint _sum(self, FootContacts contacts, double[:, ::1] vectors) noexcept
    @cython.locals(force=double, about_x=double, about_y=double)
    cdef void _spread_pairs(self, FootContacts contacts, const double[:, ::1] vectors, double reach) noexcept
    @cython.locals(total=double)
    cdef void _even(self, double force) noexcept
    @cython.locals(
        length=double, least=double, shift=double, share=double, at_x=double, at_y=double, way_x=double, way_y=double,
        span=double, along=double, px=double, py=double
    )
    cdef void _cover(self, Py_ssize_t size) noexcept
    @cython.locals(total=double, depth=double)
    cdef void _press_deep(self, Py_ssize_t size) noexcept
    cdef Py_ssize_t _hull_of(self, Py_ssize_t size) noexcept
    @cython.locals(
        cx=double, cy=double, scale=double, found=bint, a=double, b=double, c=double,
        pressure=double
    )
    cdef bint _tilt(self, double[::1] weights, double force, double x, double y) noexcept
    @cython.locals(p=double, q=double)
    cdef bint _is_beyond(self, double x, double y) noexcept
    @cython.locals(about_x=double, about_y=double, off_x=double, off_y=double)
    cdef void _balance(self, double force) noexcept
    @cython.locals(beyond=bint, p=double, q=double, area=double)
    cdef bint _carry(self, double force, double x, double y) noexcept
    @cython.locals(cx=double, cy=double, spread=double, turn=double)
    cdef void _shear(self, double force) noexcept

cdef Py_ssize_t _join(double[:, ::1] ring, Py_ssize_t corners, Py_ssize_t floor, double x, double y) noexcept
@cython.locals(deepest=double, nearest=double, px=double, py=double, along=double, gap=double)
cdef double _distance(double[:, ::1] ring, double[:, ::1] edges, Py_ssize_t corners, double x, double y) noexcept
