# C types of few_points.py. Without a compiler this file is not read.
cimport cython

@cython.locals(
    cloud=list, ring=list, part=list, p=tuple, px=double, py=double, ax=double, ay=double, bx=double, by=double
)
cpdef list small_hull(points, double tolerance=*)
