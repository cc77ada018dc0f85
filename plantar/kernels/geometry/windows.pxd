# C types of windows.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport work_arrays
from . cimport turn_bound


@cython.final
cdef class Windows:
    cdef bint lists
    cdef public Py_ssize_t spent
    cdef readonly Py_ssize_t count
    cdef Py_ssize_t used
    cdef Py_ssize_t rings
    cdef readonly double[::1] points
    cdef readonly Py_ssize_t[::1] start
    cdef readonly Py_ssize_t[::1] first
    cdef readonly double[::1] reach2
    cdef double[::1] ring
    cdef double[::1] cut

    cpdef void clear(self) noexcept

    @cython.locals(
        cosine=double, sine=double, r=Py_ssize_t, i=Py_ssize_t, n=Py_ssize_t, side=Py_ssize_t, sign=double, nx=double,
        ny=double, ring="double[::1]"
    )
    cpdef Py_ssize_t add(
        self, double[::1] points, Py_ssize_t[::1] start, Py_ssize_t rings, double angle, double[::1] box,
        Py_ssize_t at
    ) except -1

    @cython.locals(r=Py_ssize_t)
    cpdef Py_ssize_t add_whole(self, double[::1] points, Py_ssize_t[::1] start, Py_ssize_t rings) except -1

    @cython.locals(before="double[::1]", i=Py_ssize_t)
    cdef _make_buffers(self, Py_ssize_t n)
    cdef _open(self)

    @cython.locals(
        piece=Py_ssize_t, low_x=double, high_x=double, low_y=double, high_y=double, i=Py_ssize_t
    )
    cdef Py_ssize_t _close(self) except -1

    @cython.locals(i=Py_ssize_t)
    cdef _keep(self, double[::1] ring, Py_ssize_t begin, Py_ssize_t n)

@cython.locals(after="double[::1]", i=Py_ssize_t)
cdef double[::1] _longer(double[::1] before, bint lists)
@cython.locals(after="Py_ssize_t[::1]", i=Py_ssize_t)
cdef Py_ssize_t[::1] _longer_places(Py_ssize_t[::1] before, bint lists)
