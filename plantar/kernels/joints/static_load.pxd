# C types of static_load.py. Without a compiler this file is not read.
cimport cython

from ..base cimport pointers as memory

@cython.final
cdef class StaticLoad:
    cdef const Py_ssize_t[::1] parents
    cdef const Py_ssize_t[::1] bodies
    cdef const double[:, ::1] inertias
    cdef const double[:, ::1] motions
    cdef const double[::1] gravity
    cdef const Py_ssize_t[::1] places
    cdef double[::1] torques
    cdef double[:, ::1] wrenches
    cdef readonly double[::1] load

    @cython.locals(
        wrenches="double[:, ::1]", inertias="const double[:, ::1]", motions="const double[:, ::1]", count=Py_ssize_t,
        b=Py_ssize_t, p=Py_ssize_t, n=Py_ssize_t, v=Py_ssize_t, x=double, y=double, z=double, i=double, j=double,
        k=double, mass=double, even=double, odd=double
    )
    cpdef void weigh(self) noexcept

    @cython.locals(v=Py_ssize_t, numbers=cython.p_double)
    cpdef void less(self, share) except *

    @cython.locals(k=Py_ssize_t)
    cpdef void take(self) noexcept
