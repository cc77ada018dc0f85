# C types of few_points.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from . cimport hull

cdef double _INFINITE

@cython.final
cdef class FewPoints:
    cdef readonly Py_ssize_t count
    cdef readonly Py_ssize_t corners
    cdef Py_ssize_t room
    cdef double[:, ::1] points
    cdef Py_ssize_t[::1] order
    cdef Py_ssize_t[::1] chain
    cdef double[:, ::1] ring

    @cython.locals(points="double[:, ::1]", i=Py_ssize_t)
    cdef int _make_room(self, Py_ssize_t room) except -1

    cpdef void clear(self) noexcept

    cpdef int add(self, double x, double y) except -1

    @cython.locals(i=Py_ssize_t)
    cpdef int add_some(self, FewPoints other, Py_ssize_t first, Py_ssize_t end) except -1

    @cython.locals(chosen="double[:, ::1]")
    cpdef int hull(self, Py_ssize_t first, Py_ssize_t end) except -1

    @cython.locals(
        count=Py_ssize_t, i=Py_ssize_t, inner=double, outer=double, ax=double, ay=double, bx=double, by=double,
        lx=double, ly=double, dx=double, dy=double, length=double, depth=double, t=double, px=double, py=double
    )
    cpdef double margin(self, double x, double y) noexcept

    @cython.locals(total=double, i=Py_ssize_t, x=double, y=double, ax=double, ay=double, bx=double, by=double)
    cpdef double area(self) noexcept

    @cython.locals(i=Py_ssize_t)
    cpdef list points_of(self, Py_ssize_t first, Py_ssize_t end)

    @cython.locals(i=Py_ssize_t)
    cpdef list corners_of(self)
