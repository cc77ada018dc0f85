cimport cython
from libc cimport math
from .foot_contacts cimport ContactsInSole
from .foot_contacts cimport FootContacts
from . cimport pressed_patch

cdef int _CYLINDER, _BOX, _TRIES
cdef double _LEVEL, _EXACT

@cython.final
cdef class PatchLoad:
    cdef const double[:, ::1] positions, normals
    cdef const double[::1] areas
    cdef double radius
    cdef const int[::1] geom_rows, kinds, starts
    cdef const double[:, ::1] frames, sizes, planes
    cdef const double[::1] limits
    cdef const double[:, ::1] polygon, turn
    cdef readonly object block, vectors, forces, depths, wrench
    cdef double[:, ::1] _vectors, rows
    cdef double[::1] _forces, _depths, _wrench, place, face, local
    cdef int[::1] cells
    cdef readonly bint carried, touched
    cpdef void clear(self) noexcept
    cpdef bint is_lost(self) noexcept
    @cython.locals(
        extent=double, load=double, gap=double, half=double, geom=Py_ssize_t, nx=double, ny=double, nz=double
    )
    cpdef press(self, FootContacts contacts, ContactsInSole seen, double reach)
    @cython.locals(mx=double, my=double, mz=double)
    cdef void _finish(self, double least) noexcept
    @cython.locals(
        kind=int, best=double, bx=double, by=double, bz=double, far=double, sign=double, along=double, below=double, wide=double,
        face="double[::1]", local="double[::1]", p=Py_ssize_t
    )
    cdef void _find_face(self, Py_ssize_t row, double nx, double ny, double nz, double slack) noexcept
    @cython.locals(inside=bint, at=double)
    cdef bint _has(self, double x, double y, double z) noexcept
    @cython.locals(
        rows="double[:, ::1]", cu=double, cv=double, scale=double, found=bint, a=double, b=double, c=double,
        shared=double, part=double, count=Py_ssize_t
    )
    cdef void _share(
        self, double nx, double ny, double nz, double fx, double fy, double fz, double depth
    ) noexcept
    @cython.locals(
        ux=double, uy=double, uz=double, vx=double, vy=double, vz=double, length=double, square=double, away=double,
        facing=double, count=Py_ssize_t
    )
    cdef Py_ssize_t _gather(self, double nx, double ny, double nz) noexcept
    @cython.locals(least=double, away=double, nearest=Py_ssize_t)
    cdef Py_ssize_t _nearest(self) noexcept
    cdef double _facing(self, Py_ssize_t i, double nx, double ny, double nz) noexcept
    cdef void _add(self, Py_ssize_t i, double share, double fx, double fy, double fz, double depth) noexcept

@cython.locals(left=bint, right=bint, cross=double, ahead=double)
cdef bint _surrounded(double[:, ::1] rows, Py_ssize_t count, double x, double y) noexcept
