# C types of ground_reaction.py. Without a compiler this file is not read.
cimport cython
from . cimport few_points
from .foot_contacts cimport FootContacts

@cython.locals(points=list, together=list, own=list, foot=FootContacts, ring=list)
cpdef tuple ground_reaction(feet, double height, double least, double reach)

@cython.locals(force=double, x=double, y=double)
cdef tuple _reaction(double[::1] sums, double height, double least, list ring, tuple points)
