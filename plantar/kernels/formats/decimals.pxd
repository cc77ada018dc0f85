cimport cython
from ..base cimport work_arrays

cdef int _DIGITS, _TAB, _LINE_END, _BLANK, _PLUS, _COMMA, _MINUS, _POINT, _ZERO, _NINE, _LARGE_E, _SMALL_E
cdef double _LARGEST

@cython.final
cdef class _Cursor:
    cdef bytes text
    cdef const unsigned char[::1] data
    cdef Py_ssize_t size, at
    cdef int delimiter
    cdef bint comma
    cdef double value
    cdef double[::1] powers
    cdef inline bint ends_cell(self, int sign) noexcept
    cdef inline bint is_digit(self) noexcept
    @cython.locals(at=Py_ssize_t)
    cdef inline void pass_blanks(self) noexcept
    cdef inline bint pass_delimiter(self) noexcept
    cdef inline void pass_cell(self) noexcept
    cdef inline bint pass_line_end(self) noexcept
    cdef inline bint pass_sign(self) noexcept
    cdef inline int pass_exponent(self) noexcept
    @cython.locals(begin=Py_ssize_t, at=Py_ssize_t, negative=bint, sign=int, digits=Py_ssize_t, whole=long, point=Py_ssize_t, exponent=int)
    cdef inline bint read_number(self) except -1

@cython.locals(cursor=_Cursor)
cpdef Py_ssize_t read_rows(
    bytes text, int delimiter, bint comma, const Py_ssize_t[::1] columns, double[:, ::1] out
) except -1
