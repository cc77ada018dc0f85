# C types of node_heap.py. Without a compiler this file is not read.
cimport cython
from ..base cimport work_arrays


@cython.final
cdef class NodeHeap:
    cdef bint lists
    cdef readonly Py_ssize_t size
    cdef Py_ssize_t made
    cdef Py_ssize_t room
    cdef readonly double bound
    cdef readonly double low
    cdef readonly double high
    cdef readonly Py_ssize_t place
    cdef double[::1] nodes
    cdef Py_ssize_t[::1] places

    @cython.locals(nodes="double[::1]", places="Py_ssize_t[::1]", i=Py_ssize_t)
    cdef _make_room(self, Py_ssize_t room)
    cpdef void clear(self) noexcept

    @cython.locals(other=double)
    cdef bint _is_before(self, double bound, Py_ssize_t number, Py_ssize_t at) noexcept
    cdef void _put(
        self, Py_ssize_t at, double bound, double low, double high, Py_ssize_t place, Py_ssize_t number
    ) noexcept
    cdef void _move(self, Py_ssize_t source, Py_ssize_t at) noexcept

    @cython.locals(at=Py_ssize_t, number=Py_ssize_t, above=Py_ssize_t)
    cpdef void push(self, double bound, double low, double high, Py_ssize_t place) except *

    @cython.locals(last=Py_ssize_t, at=Py_ssize_t, below=Py_ssize_t, bound=double, number=Py_ssize_t)
    cpdef void pop(self) noexcept
