# C types of few_points.py. Without a compiler this file is not read.
cimport cython
from libc cimport math

cdef double _INFINITE

@cython.locals(
    cloud=list, ring=list, part=list, p=tuple, px=double, py=double, ax=double, ay=double, bx=double, by=double
)
cpdef list small_hull(points, double tolerance=*)

@cython.locals(
    inner=double, outer=double, ax=double, ay=double, bx=double, by=double, lx=double, ly=double, dx=double,
    dy=double, length=double, depth=double, t=double, px=double, py=double
)
cpdef double small_margin(list ring, double x, double y) except? -1.0
