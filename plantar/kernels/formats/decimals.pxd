cimport cython
from ..base cimport work_arrays

cdef int _DIGITS, _TAB, _LINE_END, _BLANK, _PLUS, _COMMA, _MINUS, _POINT, _ZERO, _NINE
@cython.locals(data="const unsigned char[::1]", powers="double[::1]", negative=bint, sign=int, plain=bint, value=double)
cpdef Py_ssize_t read_rows(
    bytes text, int delimiter, bint comma, const Py_ssize_t[::1] columns, double[:, ::1] out
) except -1
