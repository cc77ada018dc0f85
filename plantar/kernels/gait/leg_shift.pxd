cimport cython
from ..base cimport pointers as memory
from ..base cimport vectors

cpdef tuple accelerations(reference, shift, double inertia)
@cython.locals(x=double, y=double)
cpdef tuple dcms(state, shift, double omega)
@cython.locals(x=double, y=double, both=double)
cpdef tuple added(com, acceleration, shift, double inertia)
