cimport cython
from . cimport convex, hull

cdef double _INFINITE

@cython.final
cdef class FewPoints:
    cdef readonly Py_ssize_t count, corners
    cdef Py_ssize_t room
    cdef double[:, ::1] points
    cdef Py_ssize_t[::1] order, chain
    cdef double[:, ::1] ring
    @cython.locals(points="double[:, ::1]")
    cdef int _make_room(self, Py_ssize_t room) except -1
    cpdef void clear(self) noexcept
    cpdef int add(self, double x, double y) except -1
    cpdef int add_some(self, FewPoints other, Py_ssize_t first, Py_ssize_t end) except -1
    @cython.locals(chosen="double[:, ::1]")
    cpdef int hull(self, Py_ssize_t first, Py_ssize_t end) except -1
    cpdef double margin(self, double x, double y) noexcept
    cpdef double area(self) noexcept
    cpdef list points_of(self, Py_ssize_t first, Py_ssize_t end)
    cpdef list corners_of(self)
