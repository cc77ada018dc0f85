# C types of bracket.py. Without a compiler this file is not read.
cimport cython

cdef double _GOLDEN
cdef int _PARABOLA
cdef int _CROSSING
cdef int _BESIDE
cdef int _SECTION
cdef double _SLACK
cdef double _ASIDE
cdef double _INF

@cython.final
cdef class Bracket:
    cdef readonly double low
    cdef readonly double at_low
    cdef double beyond_low
    cdef double at_beyond_low
    cdef readonly double at
    cdef readonly double mine
    cdef readonly double high
    cdef readonly double at_high
    cdef double beyond_high
    cdef double at_beyond_high
    cdef readonly double angle
    cdef double promised
    cdef double summit
    cdef double width
    cdef double missed
    cdef double steep
    cdef int way

    cpdef void begin(self, double low, double at_low, double at, double mine) noexcept
    cpdef void stride(self, double angle, double area) noexcept
    cpdef void close(self, double angle, double area) noexcept
    cpdef bint is_closed(self, double least) noexcept

    @cython.locals(far=double, least=double)
    cpdef void propose(self) noexcept
    cdef double _aside(self, double least) noexcept

    @cython.locals(p=double, q=double, bend=double, trial=double, least=double)
    cdef void _parabola(self) noexcept

    @cython.locals(p=double, q=double, here=double, there=double, trial=double)
    cdef void _crossing(self) noexcept

    @cython.locals(angle=double, beyond=bint)
    cpdef bint take(self, double area) noexcept

    @cython.locals(gap=double)
    cdef bint _is_known(self, double area) noexcept
