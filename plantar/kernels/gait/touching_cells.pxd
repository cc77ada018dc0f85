cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors
from ..geometry cimport convex
from ..skin.percept_fields cimport ReadingFields

cdef double _INFINITE

@cython.final
cdef class TouchingCells:
    cdef const double[:, ::1] places
    cdef unsigned char[::1] touches
    cdef double least_force, least_share, smoothing, gap
    cdef double[::1] mean
    cdef double[:, ::1] slope
    cdef readonly double time
    cpdef void lift(self) noexcept
    @cython.locals(changed=bint)
    cpdef bint follow(self, ReadingFields reading, rotation, center_of_pressure) except -1
    @cython.locals(total=double, now=double, changed=bint)
    cpdef bint carry(self, force, rotation) except -1
    @cython.locals(changed=bint)
    cpdef bint turn(self, rotation, center_of_pressure) except -1

cpdef bint encloses(polygon, point) except -1
@cython.locals(dx=double, dy=double)
cpdef object along_sole(rotation, position, point)
