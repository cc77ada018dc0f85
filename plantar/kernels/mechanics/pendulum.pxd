# C types of pendulum.py. Without a compiler this file is not read.
cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.locals(
    start=cython.p_double, rate=cython.p_double, growth=cython.p_double, offset=cython.p_double, i=Py_ssize_t,
    j=Py_ssize_t, grown=double, shrunk=double, x=double, y=double, gx=double, gy=double, sx=double, sy=double
)
cpdef tuple on_segment(
    double omega, double since, double until, Py_ssize_t segment, vrps, rates, growths, shrinkage
)
