# C types of ground.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _NONE
cdef double _INFINITE
cdef int _DRAWS

@cython.final
cdef class GroundScratch:
    cdef double[:, ::1] points
    cdef Py_ssize_t[::1] taxel
    cdef unsigned char[::1] kept
    cdef double[::1] miss
    cdef double[::1] plane
    cdef const Py_ssize_t[:, ::1] triples
    cdef Py_ssize_t triples_of

@cython.final
cdef class GroundFit:
    cdef const double[:, ::1] positions
    cdef const double[:, ::1] normals
    cdef Py_ssize_t taxels
    cdef dict triples
    cdef list free

    @cython.locals(scratch=GroundScratch)
    cpdef frames(
        self, const double[:, :] distance, double reach, double tolerance, double[:, ::1] out,
        Py_ssize_t[::1] directions, unsigned char[:, ::1] inliers
    )

    @cython.locals(k=Py_ssize_t)
    cdef int _fit_each(
        self, const double[:, :] distance, double reach, double tolerance, double[:, ::1] out,
        Py_ssize_t[::1] directions, unsigned char[:, ::1] inliers, GroundScratch scratch
    ) except -1 nogil

    @cython.locals(scratch=GroundScratch, directions=int)
    cpdef int fit(
        self, const double[:] distance, double reach, double tolerance, double[::1] out, unsigned char[::1] inliers
    ) except -2

    cdef GroundScratch _borrow(self)

    @cython.locals(
        seen=Py_ssize_t, i=Py_ssize_t, d=double, directions=int, worst=double, total=double, used=Py_ssize_t
    )
    cdef int _fit(
        self, const double[:] distance, double reach, double tolerance, double[::1] out, unsigned char[::1] inliers,
        GroundScratch scratch
    ) except -2 nogil

    @cython.locals(
        table="const Py_ssize_t[:, ::1]", points="double[:, ::1]", miss="double[::1]", half=Py_ssize_t, best=double,
        best_z=double, best_x=double, best_y=double, k=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t, c=Py_ssize_t, ux=double,
        uy=double, uz=double, vx=double, vy=double, vz=double, nx=double, ny=double, nz=double, size=double,
        rise_x=double, rise_y=double, level=double, below=Py_ssize_t, i=Py_ssize_t, limit=double
    )
    cdef bint _agree(self, Py_ssize_t seen, double tolerance, GroundScratch scratch) except -1 nogil

    cdef int _find_triples(self, Py_ssize_t seen, GroundScratch scratch) except -1

@cython.locals(worst=double, i=Py_ssize_t)
cdef double _misses(Py_ssize_t seen, GroundScratch scratch) noexcept nogil

@cython.locals(
    x=double, y=double, z=double, count=Py_ssize_t, i=Py_ssize_t, xx=double, xy=double, yy=double, xz=double,
    yz=double, dx=double, dy=double, dz=double, middle=double, half=double, spread=double, large=double,
    small=double, rise_x=double, rise_y=double, directions=int, angle=double, c=double, s=double, rise=double,
    determinant=double
)
cdef int _least_squares(Py_ssize_t seen, GroundScratch scratch) noexcept nogil

@cython.locals(
    miss="double[::1]", low=Py_ssize_t, high=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, pivot=double
)
cdef double _ranked(Py_ssize_t seen, Py_ssize_t rank, GroundScratch scratch) noexcept nogil
