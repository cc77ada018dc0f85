cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.final
cdef class PendulumCourse:
    cdef double omega
    cdef const double[::1] times
    cdef const double[:, ::1] vrps, rates, growths
    cdef double[:, ::1] shrinkages
    cdef Py_ssize_t known, last
    cdef double com_x, com_y
    @cython.locals(
        k=Py_ssize_t, since=double, grown=double, shrunk=double, rx=double, ry=double, x=double, y=double, gx=double,
        gy=double, sx=double, sy=double
    )
    cpdef tuple at(self, double time)
    cpdef object end(self)
    @cython.locals(i=Py_ssize_t, decay=double, x=double, y=double)
    cdef void _start(self, Py_ssize_t count) noexcept

cpdef tuple sums(one, other)
cdef object _sum(one, other)
