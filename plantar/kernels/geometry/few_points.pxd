# C types of few_points.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _INFINITE
cdef double _FLAT

@cython.locals(
    cloud=list, ring=list, part=list, p=tuple, px=double, py=double, ax=double, ay=double, bx=double, by=double
)
cpdef list small_hull(points, double tolerance=*)


@cython.final
cdef class FewPoints:
    cdef readonly Py_ssize_t count
    cdef readonly Py_ssize_t corners
    cdef Py_ssize_t room
    cdef double[:, ::1] points
    cdef double[:, ::1] cloud
    cdef double[:, ::1] ring

    @cython.locals(points="double[:, ::1]", i=Py_ssize_t)
    cdef int _make_room(self, Py_ssize_t room) except -1

    cpdef void clear(self) noexcept

    cpdef int add(self, double x, double y) except -1

    @cython.locals(
        count=Py_ssize_t, size=Py_ssize_t, begin=Py_ssize_t, back=int, i=Py_ssize_t, k=Py_ssize_t, px=double, py=double,
        ax=double, ay=double, bx=double, by=double
    )
    cpdef void hull(self, Py_ssize_t first, Py_ssize_t end) noexcept

    @cython.locals(count=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, x=double, y=double)
    cdef Py_ssize_t _sort(self, Py_ssize_t first, Py_ssize_t end) noexcept

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
