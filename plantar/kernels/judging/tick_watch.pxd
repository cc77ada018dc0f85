# C types of tick_watch.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..contacts.ground_reaction cimport GroundReaction
from .stand_watch cimport StandWatch

cdef double _INFINITE
cdef double _MARGIN

@cython.final
cdef class TickWatch:
    cdef GroundReaction reaction
    cdef StandWatch stands
    cdef const double[::1] upright
    cdef const double[::1] center
    cdef const double[::1] left
    cdef const double[::1] right
    cdef const double[::1] left_turn
    cdef const double[::1] right_turn
    cdef const double[::1] ground
    cdef double tilted
    cdef double lowest
    cdef readonly double up
    cdef readonly double margin
    cdef public double margin_since
    cdef readonly double[::1] errors
    cdef readonly double squares
    cdef readonly Py_ssize_t compared
    cdef readonly double[::1] until
    cdef readonly double[::1] area

    @cython.locals(reaction=GroundReaction, x=double, y=double, z=double, foot=Py_ssize_t, area=double)
    cpdef bint update(self, feet, double now, list com, list zmp) except -1

    @cython.locals(dx=double, dy=double)
    cdef void _compare_zmp(self, double x, double y) noexcept

    cdef void _compare_com(self, double x, double y, double z) noexcept

    cdef void _err(self, Py_ssize_t axis, double off) noexcept

    @cython.locals(enough=double, yaw=double)
    cdef void _stand(self) noexcept

    @cython.locals(up=double, lower=double)
    cdef bint _may_have_fallen(self) noexcept
