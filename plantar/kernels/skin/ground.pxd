cimport cython
from libc cimport math

cdef double _NONE, _INFINITE
cdef int _DRAWS

@cython.final
cdef class GroundScratch:
    cdef double[:, ::1] points
    cdef Py_ssize_t[::1] taxel
    cdef unsigned char[::1] kept
    cdef double[::1] miss, plane
    cdef const Py_ssize_t[:, ::1] triples
    cdef Py_ssize_t triples_of

@cython.final
cdef class GroundFit:
    cdef const double[:, ::1] positions, normals
    cdef Py_ssize_t taxels
    cdef dict triples
    cdef list free
    cpdef frames(
        self, const double[:, :] distance, double reach, double tolerance, double[:, ::1] out,
        Py_ssize_t[::1] directions, unsigned char[:, ::1] inliers
    )
    cdef int _fit_each(
        self, const double[:, :] distance, double reach, double tolerance, double[:, ::1] out,
        Py_ssize_t[::1] directions, unsigned char[:, ::1] inliers, GroundScratch scratch
    ) except -1 nogil
    cpdef int fit(
        self, const double[:] distance, double reach, double tolerance, double[::1] out, unsigned char[::1] inliers
    ) except -2
    cdef GroundScratch _borrow(self)
    @cython.locals(total=double)
    cdef int _fit(
        self, const double[:] distance, double reach, double tolerance, double[::1] out, unsigned char[::1] inliers,
        GroundScratch scratch
    ) except -2 nogil
    @cython.locals(best_z=double, best_x=double, best_y=double)
    cdef bint _agree(self, Py_ssize_t seen, double tolerance, GroundScratch scratch) except -1 nogil
    cdef int _find_triples(self, Py_ssize_t seen, GroundScratch scratch) except -1

@cython.locals(worst=double)
cdef double _misses(Py_ssize_t seen, GroundScratch scratch) noexcept nogil
@cython.locals(
    x=double, y=double, z=double, xx=double, xy=double, yy=double, xz=double, yz=double, rise_x=double, rise_y=double
)
cdef int _least_squares(Py_ssize_t seen, GroundScratch scratch) noexcept nogil
cdef double _ranked(Py_ssize_t seen, Py_ssize_t rank, GroundScratch scratch) noexcept nogil
