cimport cython

@cython.locals(
    count=Py_ssize_t, room=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, size=Py_ssize_t, now=Py_ssize_t, new=Py_ssize_t,
    left=Py_ssize_t, following=Py_ssize_t, nx=double, ny=double, h=double, ax=double, ay=double, bx=double, by=double,
    a=double, b=double, share=double, area=double, mx=double, my=double, part=double, ox=double, oy=double
)
cpdef bint cut_cells(
    const double[:, ::1] points, const Py_ssize_t[::1] start, const double[:, ::1] lines, double[:, :, ::1] scratch,
    Py_ssize_t[:, ::1] tags, double[:, ::1] measure, double[:, :, ::1] chords
) noexcept
