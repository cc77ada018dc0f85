# C types of outline_search.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport work_arrays
from . cimport any_angle, concave, corridors, node_heap, windows

cdef Py_ssize_t _FEW
cdef Py_ssize_t _MANY
cdef double _QUARTER
cdef Py_ssize_t _SWEEPS
cdef double _FINE
cdef double _START
cdef double _WIDEST
cdef double _SHARE
cdef double _CLOSE
cdef double _PROVEN
cdef double _ROUNDING


@cython.final
cdef class OutlineSearch:
    cdef bint lists
    cdef readonly concave.OutlineRectangles outline
    cdef readonly any_angle.AnyAngle turning
    cdef corridors.Corridors sweeps
    cdef windows.Windows windows
    cdef node_heap.NodeHeap heap
    cdef double[::1] found
    cdef double[::1] turn
    cdef Py_ssize_t parts
    cdef readonly double gap

    cpdef void take(self, const double[:, :] points, object starts, bint apart) except *
    cdef double _spent(self) noexcept

    @cython.locals(outline=concave.OutlineRectangles, best=double, k=Py_ssize_t, side=Py_ssize_t)
    cpdef double at_angle(self, double angle, double[::1] out) except -1

    @cython.locals(outline=concave.OutlineRectangles, best=double)
    cdef double _start(self, double angle, double[::1] out) except -1

    @cython.locals(
        outline=concave.OutlineRectangles, length=double, r=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, dx=double,
        dy=double
    )
    cdef double _first_pitch(self) noexcept

    @cython.locals(
        outline=concave.OutlineRectangles, sweeps=corridors.Corridors, pitch=double, k=Py_ssize_t, window=Py_ssize_t,
        bound=double
    )
    cdef void _sweep(self, double angle, double half, double best) except *

    @cython.locals(outline=concave.OutlineRectangles, turning=any_angle.AnyAngle, i=Py_ssize_t)
    cpdef double at_any_angle(self, double best, double budget, double[::1] out) except -1

    @cython.locals(
        outline=concave.OutlineRectangles, turning=any_angle.AnyAngle, k=Py_ssize_t,
        best_part=Py_ssize_t, before=double, area=double,
        window=Py_ssize_t
    )
    cdef void _begin_with_parts(self, double[::1] out) except *

    @cython.locals(outline=concave.OutlineRectangles, turning=any_angle.AnyAngle, before=double)
    cdef void _march(self, double[::1] out) except *

    @cython.locals(
        outline=concave.OutlineRectangles, turning=any_angle.AnyAngle, turn="double[::1]", count=Py_ssize_t,
        k=Py_ssize_t, i=Py_ssize_t, angle=double, widest=double, low=double, at=double, pieces=Py_ssize_t
    )
    cdef void _divide(self, double area, Py_ssize_t window) except *

    @cython.locals(outline=concave.OutlineRectangles, best=double, half=double, k=Py_ssize_t)
    cdef void _begin_with_windows(self, double budget) except *

    @cython.locals(
        outline=concave.OutlineRectangles, turning=any_angle.AnyAngle, heap=node_heap.NodeHeap, loaded=Py_ssize_t,
        bound=double
    )
    cdef void _search(self, double budget, double[::1] out) except *

    @cython.locals(outline=concave.OutlineRectangles, turning=any_angle.AnyAngle, middle=double, half=double, area=double)
    cdef void _look(self, double bound, double low, double high, Py_ssize_t window, double[::1] out) except *

    @cython.locals(turning=any_angle.AnyAngle, beyond=double)
    cdef void _climb(self, double angle, double area, double[::1] out) except *

    @cython.locals(i=Py_ssize_t)
    cdef void _keep(self, double[::1] out) noexcept
