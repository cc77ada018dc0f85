cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport vectors

cpdef tuple on_segment(double omega, double since, double until, Py_ssize_t segment, vrps, rates, growths, shrinkage)
