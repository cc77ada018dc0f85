cimport cython
from libc cimport math
from ..base cimport pointers as memory
from ..base cimport vectors

@cython.final
cdef class CommandFrame:
    cdef double anchor_x, anchor_y, anchor_z, share
    cdef readonly double x, y, z, turn
    cpdef follow(self, commanded, double yaw, real, rotation)
    cpdef update(self, commanded, real, double turn)
    @cython.locals(frame=CommandFrame)
    cpdef CommandFrame now(self)
    @cython.locals(dx=double, dy=double, c=double, s=double)
    cpdef object to_command(self, point)
    @cython.locals(x=double, y=double, z=double)
    cpdef object to_world(self, point)
    @cython.locals(dx=double, dy=double, c=double, s=double, x=double, y=double, z=double)
    cpdef object aligned(self, point, com)
    @cython.locals(dx=double, dy=double, c=double, s=double)
    cdef (double, double, double) _in_world(self, point) except *
