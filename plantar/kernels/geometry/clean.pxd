cimport cython
from . cimport hull

cdef double _BOUND
cdef double _UNDERFLOW
cdef double _NEAR
cdef double _LARGEST
cdef double _SMALLEST

@cython.locals(
    k=Py_ssize_t, i=Py_ssize_t, left=Py_ssize_t, rounds=Py_ssize_t, up=bint, was_up=bint, ax=double, ay=double,
    bx=double, by=double, cx=double, cy=double, ux=double, uy=double, wx=double, wy=double, one=double, two=double,
    turn=double, size=double, least=double, length=double
)
cpdef int turning(const double[:, :] polygon, double x0, double y0, double near) noexcept

@cython.locals(i=Py_ssize_t)
cpdef Py_ssize_t anchor(const double[:, :] polygon) noexcept

@cython.locals(k=Py_ssize_t, i=Py_ssize_t, low_x=double, low_y=double, high_x=double, high_y=double, x=double, y=double)
cpdef double extent(const double[:, :] polygon) noexcept

@cython.locals(k=Py_ssize_t, size=Py_ssize_t, work="Py_ssize_t[::1]", ring="Py_ssize_t[::1]", local="double[:, ::1]")
cpdef clean_ring(const double[:, :] polygon, double x0, double y0, double near)

@cython.locals(
    i=Py_ssize_t, size=Py_ssize_t, first=Py_ssize_t, a=Py_ssize_t, b=Py_ssize_t, kept=Py_ssize_t, span=double
)
cdef Py_ssize_t _clean(
    const double[:, :] polygon, double x0, double y0, double near, double[:, ::1] local, Py_ssize_t[::1] order,
    Py_ssize_t[::1] ring
) except -1
