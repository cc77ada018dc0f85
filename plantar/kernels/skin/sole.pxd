# C types of sole.py. Without a compiler this file is not read.
cimport cython
from ..base cimport vectors
from ..geometry cimport convex, hull
from ..base cimport pointers as memory

cdef double _NONE
cdef double _INFINITE
cdef int _NOT_LOWER
cdef int _NOT_UPPER

@cython.final
cdef class SoleScratch:
    cdef double[::1] kept
    cdef double[::1] covered
    cdef Py_ssize_t[::1] lowest
    cdef Py_ssize_t[::1] highest
    cdef Py_ssize_t[::1] way
    cdef Py_ssize_t[::1] ring
    cdef double[:, ::1] polygon
    cdef double[::1] force
    cdef unsigned char[::1] mask
    cdef unsigned char[::1] other_mask
    cdef double[::1] sums
    cdef convex.OffsetRoom offset

    @cython.locals(out=cython.p_double, i=Py_ssize_t)
    cdef summed(self, Py_ssize_t first, Py_ssize_t count)

    cdef hull(self, Py_ssize_t size)

    @cython.locals(i=Py_ssize_t)
    cdef void copy_hull(self, Py_ssize_t size, double[:, ::1] out) noexcept nogil

    cdef (double, double, double) measure_hull(self, Py_ssize_t size) noexcept nogil

@cython.final
cdef class SoleKernel:
    cdef public const double[:, ::1] columns
    cdef public const double[::1] lever_x
    cdef public const double[::1] lever_y
    cdef public const double[::1] areas
    cdef public const double[:, ::1] points
    cdef public const Py_ssize_t[::1] corner_start
    cdef public const Py_ssize_t[::1] corner_rank
    cdef public const Py_ssize_t[::1] row_taxel
    cdef public const Py_ssize_t[::1] row_start
    cdef public const unsigned char[::1] corner_sign
    cdef public Py_ssize_t taxels
    cdef public Py_ssize_t corners
    cdef public double tolerance
    cdef readonly object threshold
    cdef readonly double limit
    cdef public bint flat
    cdef const Py_ssize_t[::1] corner_level
    cdef const Py_ssize_t[::1] first_end
    cdef const Py_ssize_t[::1] last_begin
    cdef Py_ssize_t levels
    cdef list free

    cdef SoleScratch borrow(self)
    cdef int give_back(self, SoleScratch scratch) except -1

    @cython.locals(out=cython.p_uchar, i=Py_ssize_t)
    cdef _copied(self, unsigned char[::1] mask)

    @cython.locals(scratch=SoleScratch, values=cython.p_double, i=Py_ssize_t)
    cdef SoleScratch _borrow_with(self, force)

    @cython.locals(values=cython.p_uchar, i=Py_ssize_t)
    cdef int _take_mask(self, active, SoleScratch scratch) except -1

    cdef int _check(self, const double[:] force) except -1

    @cython.locals(i=Py_ssize_t)
    cdef void _read(self, const double[:] force, SoleScratch scratch) noexcept

    @cython.locals(i=Py_ssize_t)
    cdef int _read_mask(self, const unsigned char[:] active, SoleScratch scratch) except -1

    @cython.locals(scratch=SoleScratch)
    cpdef active(self, force, double threshold, double saturation)

    @cython.locals(scratch=SoleScratch)
    cdef SoleScratch _borrow_with_active(self, force, double threshold, double saturation)

    @cython.locals(i=Py_ssize_t)
    cdef void activate(
        self, const double[:] force, double threshold, double saturation, unsigned char[::1] out
    ) noexcept nogil

    @cython.locals(scratch=SoleScratch, i=Py_ssize_t, finite=bint)
    cpdef faults(self, force, double saturation)

    @cython.locals(scratch=SoleScratch)
    cpdef loads(self, force, active)

    @cython.locals(scratch=SoleScratch)
    cpdef loads_above(self, force, double threshold, double saturation)

    @cython.locals(
        values=cython.p_double, out=cython.p_double, i=Py_ssize_t, f=double, fz=double, tx=double, ty=double, area=double
    )
    cpdef unsaturated_loads(self, force, double threshold, double saturation)

    @cython.locals(scratch=SoleScratch, i=Py_ssize_t, largest=double)
    cpdef bint reaches(self, force, double level) except *

    @cython.locals(
        fx=double, fy=double, fz=double, tx=double, ty=double, tz=double, area=double,
        sx=double, sy=double, i=Py_ssize_t, f=double
    )
    cdef void _loads(self, const double[:] force, const unsigned char[:] active, double[::1] out) noexcept nogil

    @cython.locals(scratch=SoleScratch)
    cpdef hull(self, active)

    cpdef hull_above(self, force, double threshold, double saturation)

    @cython.locals(size=Py_ssize_t, area=double, x=double, y=double)
    cdef _hull(self, SoleScratch scratch)

    @cython.locals(
        scratch=SoleScratch, contact=double, size=Py_ssize_t, left=Py_ssize_t, area=double,
        middle_x=double, middle_y=double, near_x=double, near_y=double, _margin=double
    )
    cpdef tick(self, force, double threshold, double saturation, double offset, double x, double y)

    @cython.locals(
        kind=int, at=Py_ssize_t,
        left=Py_ssize_t, right=Py_ssize_t, forth=Py_ssize_t, count=Py_ssize_t, row=Py_ssize_t, first=Py_ssize_t,
        last=Py_ssize_t, end=int, from_corner=Py_ssize_t, to_corner=Py_ssize_t, i=Py_ssize_t, c=Py_ssize_t, v=Py_ssize_t, size=Py_ssize_t
    )
    cdef Py_ssize_t find_hull(self, const unsigned char[:] active, SoleScratch scratch) noexcept nogil
