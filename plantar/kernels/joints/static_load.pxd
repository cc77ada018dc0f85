cimport cython
from ..base cimport pointers as memory
from .task_step cimport PointRows

@cython.final
cdef class StaticLoad:
    cdef const Py_ssize_t[::1] parents, bodies
    cdef const double[:, ::1] inertias, motions
    cdef const double[::1] gravity
    cdef const Py_ssize_t[::1] places
    cdef double[::1] torques
    cdef double[:, ::1] wrenches
    cdef readonly double[::1] load
    cpdef void weigh(self) noexcept
    @cython.locals(rows="double[:, ::1]")
    cpdef void less(self, PointRows lever, force, double x, double y, double z) except *
    @cython.locals(pressing=double, other=double)
    cpdef double stand(
        self, tuple levers, left, left_point, left_place, right, right_point, right_place
    ) except? -1.0
    @cython.locals(pressing=double)
    cdef double _press(self, PointRows lever, force, point, place) except? -1.0
    cpdef void take(self) noexcept
