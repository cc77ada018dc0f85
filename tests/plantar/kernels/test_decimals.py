"""Numbers read from text are what Python's `float` makes of them, to the last bit, in either form of the kernel."""

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.formats import decimals

FORMS = [decimals, kernels.python_form("decimals")]


def any_number(rng: np.random.Generator) -> str:
    """A number as some program may write it: of any length, with zeros before and behind, exponents, signs."""
    digits = "".join(map(str, rng.integers(0, 10, rng.choice([1, 2, 3, 5, 8, 14, 15, 16, 17, 19, 25, 40]))))
    point = int(rng.integers(0, len(digits) + 1))
    text = digits if rng.random() < 0.2 else f"{digits[:point]}.{digits[point:]}"
    text = rng.choice(["", "0", "000", "-", "+", "-0"]) + text
    if rng.random() < 0.25:
        text += rng.choice(["e", "E"]) + rng.choice(["", "+", "-"]) + str(rng.integers(0, 40))
    return text if rng.random() < 0.8 else repr(float(rng.normal() * 10.0 ** rng.integers(-12, 12)))


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(("delimiter", "point"), [("\t", "."), (";", ","), (",", "."), (" ", ".")])
def test_each_number_is_what_float_makes_of_it(form, delimiter, point):
    rng = np.random.default_rng(len(delimiter) + ord(delimiter) + ord(point))
    texts = [[any_number(rng) for _ in range(7)] for _ in range(300)]
    lines = "".join(delimiter.join(row).replace(".", point) + "\n" for row in texts)
    out = np.full((len(texts), 7), -1.0)
    sign = 0 if delimiter == " " else ord(delimiter)
    assert form.read_rows(lines.encode(), sign, point == ",", np.arange(7), out) == len(texts)
    expected = np.array([[float(text) for text in row] for row in texts])
    assert out.tobytes() == expected.tobytes()  # -0.0 too


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(
    ("line", "delimiter", "values"),
    [
        ("1\t2\t3", "\t", [1.0, 2.0, 3.0]),
        (" 1 \t\t 3\t\t", "\t", [1.0, np.nan, 3.0]),
        ("\t\t", "\t", [np.nan, np.nan, np.nan]),
        ("  1   2\t3 \t ", None, [1.0, 2.0, 3.0]),
        ("1,5;.5;5.", ";", [1.5, 0.5, 5.0]),
        ("1\t2", "\t", None),
        ("1\t2\t3\t4", "\t", None),
        ("1 2\t3\t4", "\t", None),
        ("1\t\t3", None, None),
        ("1 2 3 4", None, None),
        ("1\t2x\t3", "\t", None),
        ("1\t-\t3", "\t", None),
        ("1\t.\t3", "\t", None),
        ("1\t1.2.3\t3", "\t", None),
        ("1\t1e\t3", "\t", None),
        ("1\t1e999\t3", "\t", None),
        ("1\tnan\t3", "\t", None),
        ("1\tinf\t3", "\t", None),
        ("1\t0x1\t3", "\t", None),
        ("1\t1_0\t3", "\t", None),
        ('1\t"2"\t3', "\t", None),
        ("", "\t", None),
    ],
)
@pytest.mark.parametrize("end", ["\n", ""])
def test_a_line_of_anything_else_is_not_read(form, line, delimiter, values, end):
    out = np.zeros((3, 3))
    text = f"7{delimiter or ' '}8{delimiter or ' '}9\n{line}{end}".encode()
    read = form.read_rows(text, 0 if delimiter is None else ord(delimiter), delimiter != ",", np.arange(3), out)
    assert read == (1 if values is None else 2)
    assert out[0].tolist() == [7.0, 8.0, 9.0]
    if values is not None:
        np.testing.assert_array_equal(out[1], values)


@pytest.mark.parametrize("form", FORMS)
def test_columns_that_nobody_wants_may_hold_anything(form):
    out = np.zeros((2, 2))
    read = form.read_rows(b"1,label x,3\n4,,6", ord(","), False, np.array([1, -1, 0]), out)
    assert read == 2
    assert out.tolist() == [[3.0, 1.0], [6.0, 4.0]]
