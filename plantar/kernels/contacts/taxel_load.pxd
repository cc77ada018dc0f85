# C types of taxel_load.py. Without a compiler this file is not read.
cimport cython
from .contacts_in_sole cimport ContactsInSole
from .foot_contacts cimport FootContacts

cdef double _SPREAD
cdef double _FAINT
cdef double _EXACT


@cython.final
cdef class TaxelLoad:
    cdef const double[:, ::1] positions
    cdef const double[:, ::1] normals
    cdef const double[::1] areas
    cdef const double[::1] widths
    cdef const double[:, ::1] hull
    cdef bint level
    cdef readonly object vectors
    cdef readonly object forces
    cdef readonly object depths
    cdef readonly object wrench
    cdef double[:, ::1] _vectors
    cdef double[::1] _forces
    cdef double[::1] _depths
    cdef double[::1] _wrench
    cdef double[::1] weights
    cdef double[::1] prior
    cdef double[::1] normal
    cdef double[::1] gaps
    cdef readonly bint carried
    cdef readonly bint pressed
    cdef Py_ssize_t room
    cdef double[:, ::1] points
    cdef double[:, ::1] ring
    cdef double[:, ::1] edges
    cdef double[:, ::1] rows

    cdef int _make_room(self, Py_ssize_t room) except -1

    @cython.locals(count=Py_ssize_t, i=Py_ssize_t, force=double)
    cpdef press(self, FootContacts contacts, ContactsInSole seen, double reach)

    @cython.locals(
        k=Py_ssize_t, row=Py_ssize_t, x=double, y=double, z=double, fx=double, fy=double, fz=double
    )
    cdef void _sum(self, FootContacts contacts, const double[:, ::1] vectors) noexcept

    @cython.locals(
        count=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t, i=Py_ssize_t, known=bint, force=double, about_x=double,
        about_y=double, size=Py_ssize_t, row=Py_ssize_t, x=double, y=double, z=double, total=double
    )
    cdef void _spread_pairs(self, FootContacts contacts, const double[:, ::1] vectors, double reach) noexcept

    @cython.locals(
        corners=Py_ssize_t, count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, x=double, y=double, length=double,
        least=double, gap=double, shift=double, share=double
    )
    cdef void _cover(self, Py_ssize_t size) noexcept

    @cython.locals(i=Py_ssize_t, k=Py_ssize_t, total=double, depth=double, x=double, y=double, near=double)
    cdef void _press_deep(self, Py_ssize_t size) noexcept

    @cython.locals(
        k=Py_ssize_t, j=Py_ssize_t, x=double, y=double, z=double, corners=Py_ssize_t, floor=Py_ssize_t,
        points=double[:, ::1], ring=double[:, ::1]
    )
    cdef Py_ssize_t _hull_of(self, Py_ssize_t size) noexcept

    @cython.locals(
        cells=Py_ssize_t, i=Py_ssize_t, turn=int, rows=double[:, ::1], total=double, cx=double, cy=double, w=double, spread=double, p=double,
        q=double, scale=double, at_x=double, at_y=double, a=double, b=double, c=double, step_a=double, step_b=double,
        step_c=double, slope=double, value=double, rate=double, r0=double, r1=double, r2=double, m00=double, m01=double,
        m02=double, m11=double, m12=double, m22=double, energy=double, pressure=double, ridge=double, i00=double,
        i01=double, i02=double, i11=double, i12=double, i22=double, determinant=double
    )
    cdef bint _tilt(self, double[::1] weights, double force, double x, double y) noexcept

    @cython.locals(
        count=Py_ssize_t, i=Py_ssize_t, _=int, about_x=double, about_y=double, off_x=double, off_y=double, x=double,
        y=double, z=double
    )
    cdef void _balance(self, double force) noexcept

    @cython.locals(
        count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, _=int, stage=int, area=double, near=bint, p=double,
        q=double, inside_x=double, inside_y=double, corners=Py_ssize_t, near_x=double, near_y=double, total=double
    )
    cdef bint _carry(self, double force, double x, double y) noexcept

    @cython.locals(
        count=Py_ssize_t, i=Py_ssize_t, cx=double, cy=double, spread=double, p=double, q=double, twist=double,
        turn=double, share=double
    )
    cdef void _shear(self, double force) noexcept


cdef bint _is_pair(FootContacts contacts, Py_ssize_t j, Py_ssize_t k) noexcept

@cython.locals(ax=double, ay=double)
cdef Py_ssize_t _join(double[:, ::1] ring, Py_ssize_t corners, Py_ssize_t floor, double x, double y) noexcept

@cython.locals(
    deepest=double, nearest=double, k=Py_ssize_t, px=double, py=double, out=double, along=double, gap=double
)
cdef double _distance(
    double[:, ::1] ring, double[:, ::1] edges, Py_ssize_t corners, double x, double y
) noexcept

@cython.locals(
    best=double, best_x=double, best_y=double, corners=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t, ax=double, ay=double,
    px=double, py=double, square=double, along=double, gap=double
)
cdef (double, double) _nearest(const double[:, ::1] hull, double x, double y) noexcept
