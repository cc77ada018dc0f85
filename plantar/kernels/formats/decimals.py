# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Reads rows of decimal numbers, each equal to `float` to the last bit.

Up to 15 digits are a whole number below 2^53 over a power of ten up to 10^15, both exact doubles, so their quotient is
the nearest double (Clinger 1990).
"""

import math

from ..base import work_arrays

__all__ = ["read_rows"]

_DIGITS = 15
_TAB = 9
_LINE_END = 10
_BLANK = 32
_PLUS = 43
_COMMA = 44
_MINUS = 45
_POINT = 46
_ZERO = 48
_NINE = 57
_LARGE_E = 69
_SMALL_E = 101
_LARGEST = 1.7976931348623157e308


def read_rows(text, delimiter, comma, columns, out):
    """Read lines of numbers up to the first other one; returns their number.

    `delimiter`: code of sign between numbers, doubled for a missing one; 0 for blanks; `columns`: column of `out` for
    each number of a line; -1 to skip it; `out`: receives numbers, a row a line; NaN for a missing one.
    """
    cursor = _Cursor(text, delimiter, comma)
    row = 0
    while cursor.at < cursor.size and row < out.shape[0]:
        for k in range(len(columns)):
            if k > 0 and not cursor.pass_delimiter():
                return row
            cursor.pass_blanks()
            if columns[k] < 0 and delimiter != 0:
                cursor.pass_cell()
                continue
            if not cursor.read_number():
                return row
            if columns[k] >= 0:
                out[row, columns[k]] = cursor.value
        if not cursor.pass_line_end():
            return row
        row += 1
    return row


class _Cursor:
    """A place in a text, and the last number read before it."""

    def __init__(self, text, delimiter, comma):
        self.text = text
        self.data = text
        self.size = len(text)
        self.delimiter = delimiter
        self.comma = comma
        self.at = 0
        self.value = math.nan
        self.powers = work_arrays.numbers(_DIGITS + 1, False)
        self.powers[0] = 1.0
        for k in range(_DIGITS):
            self.powers[k + 1] = 10.0 * self.powers[k]

    # Pass blanks, and tabs that part no numbers.
    def pass_blanks(self):
        at = self.at
        while at < self.size and (self.data[at] == _BLANK or (self.data[at] == _TAB and self.delimiter != _TAB)):
            at += 1
        self.at = at

    # Pass the delimiter and blanks before it; returns whether one is there.
    def pass_delimiter(self):
        before = self.at
        self.pass_blanks()
        if self.delimiter == 0:
            return self.at > before
        if self.at == self.size or self.data[self.at] != self.delimiter:
            return False
        self.at += 1
        return True

    # Pass a cell up to its delimiter or the line's end, whatever it holds.
    def pass_cell(self):
        while self.at < self.size and self.data[self.at] != self.delimiter and self.data[self.at] != _LINE_END:
            self.at += 1

    # Pass empty cells too many and the line's end; returns whether nothing else is left of the line.
    def pass_line_end(self):
        while self.at < self.size and self.ends_cell(self.data[self.at]):
            self.at += 1
        if self.at == self.size:
            return True
        self.at += 1
        return self.data[self.at - 1] == _LINE_END

    # Whether a sign is a blank or a delimiter.
    def ends_cell(self, sign):
        return sign in (_BLANK, _TAB) or (self.delimiter != 0 and sign == self.delimiter)

    # Whether a digit is next.
    def is_digit(self):
        return self.at < self.size and _ZERO <= self.data[self.at] <= _NINE

    # Pass a sign of a number; returns whether it is a minus.
    def pass_sign(self):
        if self.at == self.size or (self.data[self.at] != _MINUS and self.data[self.at] != _PLUS):
            return False
        self.at += 1
        return self.data[self.at - 1] == _MINUS

    # Pass an exponent; returns 1 if one is there, 0 if none, -1 if it has no digits.
    def pass_exponent(self):
        if self.at == self.size or (self.data[self.at] != _LARGE_E and self.data[self.at] != _SMALL_E):
            return 0
        self.at += 1
        self.pass_sign()
        if not self.is_digit():
            return -1
        while self.is_digit():
            self.at += 1
        return 1

    # Read a number into `value`, NaN for an empty cell; returns whether it is one of these.
    def read_number(self):
        begin = self.at
        negative = self.pass_sign()
        digits = 0
        whole = 0
        point = -1
        at = self.at  # a place of its own, which the loop need not store
        while at < self.size:
            sign = self.data[at]
            if _ZERO <= sign <= _NINE:
                digits += 1
                if digits <= _DIGITS:
                    whole = 10 * whole + (sign - _ZERO)
            elif point < 0 and (sign == _POINT or (self.comma and sign == _COMMA)):
                point = digits
            else:
                break
            at += 1
        self.at = at
        if digits == 0:
            self.value = math.nan
            return at == begin and self.delimiter != 0
        exponent = self.pass_exponent()
        if exponent == 0 and digits <= _DIGITS:
            self.value = whole / self.powers[0 if point < 0 else digits - point]
            if negative:
                self.value = -self.value
            return True
        if exponent < 0:
            return False
        self.value = float(self.text[begin : self.at].replace(b",", b"."))
        return abs(self.value) <= _LARGEST
