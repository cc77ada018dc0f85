cimport cython
from ..base cimport vectors
from ..geometry cimport convex, hull
from ..base cimport pointers as memory

cdef double _NONE, _INFINITE
cdef int _NOT_LOWER, _NOT_UPPER

@cython.final
cdef class SoleScratch:
    cdef double[::1] kept, covered
    cdef Py_ssize_t[::1] lowest, highest, way, ring
    cdef double[:, ::1] polygon
    cdef double[::1] force
    cdef unsigned char[::1] mask
    cdef unsigned char[::1] other_mask
    cdef double[::1] sums
    cdef convex.OffsetRoom offset
    cdef summed(self, Py_ssize_t first, Py_ssize_t count)
    cdef hull(self, Py_ssize_t size)
    cdef void copy_hull(self, Py_ssize_t size, double[:, ::1] out) noexcept nogil
    cdef (double, double, double) measure_hull(self, Py_ssize_t size) noexcept nogil

@cython.final
cdef class SoleKernel:
    cdef public const double[:, ::1] columns
    cdef public const double[::1] lever_x, lever_y, areas
    cdef public const double[:, ::1] points
    cdef public const Py_ssize_t[::1] corner_start, corner_rank, row_taxel, row_start
    cdef public const unsigned char[::1] corner_sign
    cdef public Py_ssize_t taxels, corners
    cdef public double tolerance
    cdef readonly object threshold
    cdef readonly double limit
    cdef double level
    cdef readonly double cell_contact, sole_contact
    cdef bint noisy
    cdef public bint flat
    cdef const Py_ssize_t[::1] corner_level, first_end, last_begin
    cdef Py_ssize_t levels
    cdef list free
    cdef SoleScratch borrow(self)
    cdef int give_back(self, SoleScratch scratch) except -1
    cdef _copied(self, unsigned char[::1] mask)
    cdef SoleScratch _borrow_with(self, force)
    cdef int _take_mask(self, active, SoleScratch scratch) except -1
    cdef int _check(self, const double[:] force) except -1
    cdef void _read(self, const double[:] force, SoleScratch scratch) noexcept
    cdef int _read_mask(self, const unsigned char[:] active, SoleScratch scratch) except -1
    cpdef active(self, force, double threshold, double saturation)
    cdef SoleScratch _borrow_with_active(self, force, double threshold, double saturation)
    @cython.locals(touching=bint)
    cdef void activate(
        self, const double[:] force, double threshold, double saturation, unsigned char[::1] out
    ) noexcept nogil
    @cython.locals(total=double)
    cdef bint touches(self, const double[:] force, double threshold) noexcept nogil
    @cython.locals(finite=bint)
    cpdef faults(self, force, double saturation)
    cpdef loads(self, force, active)
    cpdef loads_above(self, force, double threshold, double saturation)
    @cython.locals(fz=double, tx=double, ty=double, area=double, largest=double, total=double)
    cpdef unsaturated_loads(self, force, double threshold, double saturation)
    cpdef bint reaches(self, force, double level) except *
    @cython.locals(fx=double, fy=double, fz=double, tx=double, ty=double, tz=double, area=double, sx=double, sy=double)
    cdef void _loads(self, const double[:] force, const unsigned char[:] active, double[::1] out) noexcept nogil
    cpdef hull(self, active)
    cpdef hull_above(self, force, double threshold, double saturation)
    cdef _hull(self, SoleScratch scratch)
    cpdef tick(self, force, double threshold, double saturation, double offset, double x, double y)
    @cython.locals(kind=int)
    cdef Py_ssize_t find_hull(self, const unsigned char[:] active, SoleScratch scratch) noexcept nogil
