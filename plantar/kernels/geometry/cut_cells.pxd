cimport cython
from ..base cimport pointers as memory

@cython.locals(area=double, mx=double, my=double)
cpdef bint cut_cells(
    const double[:, ::1] points, const Py_ssize_t[::1] start, const double[:, ::1] lines, double[:, :, ::1] scratch,
    Py_ssize_t[:, ::1] tags, double[:, ::1] measure, double[:, :, ::1] chords
) noexcept

cpdef part_below(polygon, double nx, double ny, double h)
