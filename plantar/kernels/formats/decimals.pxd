# C types of decimals.py. Without a compiler this file is not read.
cimport cython
from ..base cimport work_arrays

cdef int _DIGITS
cdef int _TAB
cdef int _LINE_END
cdef int _BLANK
cdef int _PLUS
cdef int _COMMA
cdef int _MINUS
cdef int _POINT
cdef int _ZERO
cdef int _NINE

@cython.locals(
    data="const unsigned char[::1]", size=Py_ssize_t, width=Py_ssize_t, powers="double[::1]", k=Py_ssize_t,
    at=Py_ssize_t, row=Py_ssize_t, begin=Py_ssize_t, end=Py_ssize_t, negative=bint, digits=Py_ssize_t,
    whole="long long", point=Py_ssize_t, sign=int, plain=bint, value=double
)
cpdef Py_ssize_t read_rows(
    bytes text, int delimiter, bint comma, const Py_ssize_t[::1] columns, double[:, ::1] out
) except -1
