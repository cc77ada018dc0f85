cimport cython
from .configuration cimport Configuration
from .newton_step cimport NewtonStep
from .task_rows cimport Rows

@cython.final
cdef class TaskStep:
    cdef list rows
    cdef NewtonStep newton
    cdef Configuration configuration
    cdef readonly bint near
    @cython.locals(rows=Rows)
    cpdef bint step(self, double largest) except *
    cpdef void move(self) noexcept
