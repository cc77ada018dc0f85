# C types of sole_targets.py. Without a compiler this file is not read.
cimport cython
from ..base cimport fused_in_c as fused
from ..base cimport pointers as memory
from ..mechanics cimport rotations
from ..base cimport vectors

@cython.locals(
    before=cython.p_double, out=cython.p_double, i=Py_ssize_t, a=double, b=double, c=double, xx=double, xy=double,
    xz=double, yx=double, yy=double, yz=double, zx=double, zy=double, zz=double
)
cpdef object turned(level, double x, double y)

@cython.locals(place=cython.p_double, middle=cython.p_double, rise=double)
cpdef object risen(position, center, double roll, double pitch, double shift)

@cython.locals(
    w=cython.p_double, r=cython.p_double, place=cython.p_double, middle=cython.p_double, x=double, y=double
)
cpdef tuple pressed(wrench, level, position, center)
