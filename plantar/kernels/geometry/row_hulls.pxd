cimport cython

@cython.locals(work="Py_ssize_t[:, ::1]", rows=Py_ssize_t, i=Py_ssize_t, at=Py_ssize_t)
cpdef hull_areas(
    const double[:, :] force, const Py_ssize_t[::1] row, const Py_ssize_t[::1] column, double[::1] area
)
@cython.locals(
    size=Py_ssize_t, twice=Py_ssize_t, before=bint, after=bint, least=Py_ssize_t, other=Py_ssize_t, line=Py_ssize_t
)
cdef Py_ssize_t _twice_below(Py_ssize_t[:, ::1] work, Py_ssize_t rows, Py_ssize_t side, Py_ssize_t sign) noexcept nogil
