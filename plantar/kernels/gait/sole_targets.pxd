cimport cython
from ..base cimport fused_in_c as fused
from ..base cimport pointers as memory
from ..mechanics cimport rotations
from ..base cimport vectors

cpdef object turned(level, double x, double y)
cpdef object risen(position, center, double roll, double pitch, double shift)
cpdef tuple pressed(wrench, level, position, center)
