cimport cython
from . cimport hull

cdef double _BOUND, _UNDERFLOW, _NEAR, _LARGEST, _SMALLEST
@cython.locals(up=bint, was_up=bint, size=double, least=double)
cpdef int turning(const double[:, :] polygon, double x0, double y0, double near) noexcept
cpdef Py_ssize_t anchor(const double[:, :] polygon) noexcept
@cython.locals(low_x=double, low_y=double, high_x=double, high_y=double)
cpdef double extent(const double[:, :] polygon) noexcept
@cython.locals(work="Py_ssize_t[::1]", ring="Py_ssize_t[::1]", local="double[:, ::1]")
cpdef clean_ring(const double[:, :] polygon, double x0, double y0, double near)
@cython.locals(span=double)
cdef Py_ssize_t _clean(
    const double[:, :] polygon, double x0, double y0, double near, double[:, ::1] local, Py_ssize_t[::1] order,
    Py_ssize_t[::1] ring
) except -1
