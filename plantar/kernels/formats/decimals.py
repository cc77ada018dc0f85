# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Reads rows of decimal numbers, each equal to `float` to the last bit.

Up to 15 digits are a whole number below 2^53 over a power of ten up to 10^15, both exact doubles, so their quotient is
the nearest double (Clinger 1990).
"""

import math

from ..base import work_arrays

__all__ = ["read_rows"]

_DIGITS = 15
_TAB, _LINE_END, _BLANK, _PLUS, _COMMA, _MINUS, _POINT, _ZERO, _NINE = 9, 10, 32, 43, 44, 45, 46, 48, 57


def read_rows(text, delimiter, comma, columns, out):
    """Read lines of numbers up to the first other one; returns their number.

    Args:
        text: Lines, as bytes.
        delimiter: Code of sign between numbers, doubled for a missing one; 0 for blanks.
        comma: Whether numbers may have a decimal comma.
        columns: Column of `out` for each number of a line; -1 to skip it.
        out: Receives numbers, a row a line; NaN for a missing one.
    """
    data = text
    size = len(text)
    width = len(columns)
    powers = work_arrays.numbers(_DIGITS + 1, False)
    powers[0] = 1.0
    for k in range(_DIGITS):
        powers[k + 1] = 10.0 * powers[k]
    at = 0
    row = 0
    while at < size and row < out.shape[0]:
        for k in range(width):
            while at < size and (data[at] == _BLANK or (data[at] == _TAB and delimiter != _TAB)):
                at += 1
            begin = at
            if columns[k] < 0 and delimiter != 0:
                while at < size and data[at] != delimiter and data[at] != _LINE_END:
                    at += 1
            else:
                negative = False
                if at < size and (data[at] == _MINUS or data[at] == _PLUS):
                    negative = data[at] == _MINUS
                    at += 1
                digits = 0
                whole = 0
                point = -1
                while at < size:
                    sign = data[at]
                    if _ZERO <= sign <= _NINE:
                        digits += 1
                        if digits <= _DIGITS:
                            whole = 10 * whole + (sign - _ZERO)
                    elif point < 0 and (sign == _POINT or (comma and sign == _COMMA)):
                        point = digits
                    else:
                        break
                    at += 1
                plain = digits <= _DIGITS
                if digits > 0 and at < size and (data[at] == 69 or data[at] == 101):  # E, e
                    plain = False
                    at += 1
                    if at < size and (data[at] == _MINUS or data[at] == _PLUS):
                        at += 1
                    if at == size or not _ZERO <= data[at] <= _NINE:
                        return row
                    while at < size and _ZERO <= data[at] <= _NINE:
                        at += 1
                if digits == 0:
                    if at > begin or delimiter == 0:
                        return row
                    value = math.nan
                elif plain:
                    value = whole / powers[0 if point < 0 else digits - point]
                    if negative:
                        value = -value
                else:
                    value = float(text[begin:at].replace(b",", b"."))
                    if not abs(value) <= 1.7976931348623157e308:
                        return row
                if columns[k] >= 0:
                    out[row, columns[k]] = value
            end = at
            while at < size and (data[at] == _BLANK or (data[at] == _TAB and delimiter != _TAB)):
                at += 1
            if k + 1 < width:
                if delimiter == 0:
                    if at == end:
                        return row
                elif at < size and data[at] == delimiter:
                    at += 1
                else:
                    return row
        while at < size and (data[at] == _BLANK or data[at] == _TAB or (delimiter != 0 and data[at] == delimiter)):
            at += 1  # empty ones too many
        if at < size:
            if data[at] != _LINE_END:
                return row
            at += 1
        row += 1
    return row
