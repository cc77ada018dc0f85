cimport cython
from ..base cimport pointers as memory

cpdef part_below(polygon, double nx, double ny, double h)
