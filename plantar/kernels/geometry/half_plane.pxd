cimport cython

from ..base cimport pointers as memory

@cython.locals(
    size=Py_ssize_t, count=Py_ssize_t, k=Py_ssize_t, n=Py_ssize_t, given=cython.p_double, kept=cython.p_double,
    out=cython.p_double, ax=double, ay=double, bx=double, by=double, a=double, b=double, share=double
)
cpdef part_below(polygon, double nx, double ny, double h)
