"""Wrong arguments for every public function that takes arrays: no silent answer, no raw error, no crash.

One array of a right call is replaced by a member of a family. Where the member holds the same numbers in another form
(a list, float32, another byte order or stride), the answer is the same; where it holds numbers of a shape that the
function takes, there is an answer; anything else is a PlantarError of one line that names the argument.
"""

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import PlantarError
from plantar.geometry.outline import Outline

from .public_calls import Argument, Call

Array = NDArray[Any]
_ROUNDING = 1e-13  # of an answer's largest number
Draw = Callable[[Array, np.random.Generator], Any]


class _Foreign:
    """An object of another library that says it is an array, and is of a kind that numpy makes an object of."""

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.shape, self.dtype, self.ndim = shape, np.dtype(float), len(shape)


def _strided(value: Array, _: np.random.Generator) -> Array:
    wide = np.full([2 * n + 1 for n in value.shape], 7, dtype=value.dtype)
    view = wide[tuple(slice(0, 2 * n, 2) for n in value.shape)]
    view[...] = value
    return view


def _read_only(value: Array, _: np.random.Generator) -> Array:
    copy = value.copy()
    copy.setflags(write=False)
    return copy


def _longer(value: Array, rng: np.random.Generator) -> Array:
    axis = int(rng.integers(max(1, value.ndim)))
    return np.concatenate([value, value.take([0], axis=axis)], axis=axis)


def _shorter(value: Array, rng: np.random.Generator) -> Array:
    axis = int(rng.integers(max(1, value.ndim)))
    return value.take(range(value.shape[axis] - 1), axis=axis)


def _with(number: float) -> Draw:
    def draw(value: Array, rng: np.random.Generator) -> Array:
        out = value.astype(float)
        out.flat[int(rng.integers(out.size))] = number
        return out

    return draw


def _none_inside(value: Array, _: np.random.Generator) -> Array:
    out = value.astype(object)
    out.flat[0] = None
    return out


def _ragged(value: Array, _: np.random.Generator) -> Any:
    rows = value.tolist()
    return [rows, rows[:-1]] if value.ndim == 1 else [*rows[:-1], rows[-1][:-1]]


def _masked(value: Array, _: np.random.Generator) -> Any:
    hidden = np.zeros(value.shape, dtype=bool)
    hidden.flat[0] = True
    return np.ma.MaskedArray(value, hidden)


def _sparse(value: Array, _: np.random.Generator) -> Any:
    try:
        from scipy import sparse
    except ImportError:
        return _Foreign(value.shape)
    return sparse.csr_matrix(np.atleast_2d(value).reshape(len(np.atleast_2d(value)), -1))


_FORMS: dict[str, Draw] = {
    "list": lambda v, _: v.tolist(),
    "tuple": lambda v, _: tuple(v.tolist()),
    "other byte order": lambda v, _: v.astype(v.dtype.newbyteorder()),
    "stride": _strided,
    "column order": lambda v, _: np.asfortranarray(v),
    "backwards": lambda v, _: v[::-1].copy()[::-1],
    "read-only": _read_only,
    "float32": lambda v, _: v.astype(np.float32) if v.dtype.kind == "f" and (v == v.astype(np.float32)).all() else v,
    "long double": lambda v, _: v.astype(np.longdouble) if v.dtype.kind == "f" else v,
}
"""The same numbers in another form."""

_SHAPES: dict[str, Draw] = {
    "column": lambda v, _: v.reshape(-1, 1),
    "row": lambda v, _: v.reshape(1, -1),
    "flat": lambda v, _: v.ravel(),
    "one axis more": lambda v, _: v[None],
    "one axis more behind": lambda v, _: v[..., None],
    "five axes": lambda v, _: v[None, None, None, ..., None],
    "transposed": lambda v, _: v.T,
    "three columns": lambda v, _: np.zeros((len(v) if v.ndim else 1, 3)),
    "one column": lambda v, _: np.zeros((len(v) if v.ndim else 1, 1)),
    "no columns": lambda v, _: np.zeros((len(v) if v.ndim else 1, 0)),
    "empty": lambda v, _: np.zeros(0),
    "no rows": lambda v, _: v[:0] if v.ndim else np.zeros(0),
    "no list": lambda v, _: [],
    "number": lambda v, _: 1.0,
    "array of one number": lambda v, _: np.array(1.0),
    "one more": _longer,
    "one less": _shorter,
    "first row": lambda v, _: v[0] if v.ndim else v,
    "nested": lambda v, _: [[v.tolist()]],
}
"""The numbers in another shape, which a function may take or not."""

_NUMBERS: dict[str, Draw] = {
    "NaN": _with(math.nan),
    "inf": _with(math.inf),
    "-inf": _with(-math.inf),
    "1e300": _with(1e300),
    "-1e308": _with(-1e308),
    "5e-324": _with(5e-324),
    "all NaN": lambda v, _: np.full(v.shape, math.nan),
    "all 1e300": lambda v, _: np.full(v.shape, 1e300),
    "zeros": lambda v, _: np.zeros(v.shape),
    "whole numbers": lambda v, _: np.asarray(v).astype(int),
    "truth values": lambda v, _: np.asarray(v) > 0,
    "small whole numbers": lambda v, _: np.asarray(v).astype(np.int8),
    "largest whole numbers": lambda v, _: np.full(v.shape, 2**63 - 1),
    "largest unsigned numbers": lambda v, _: np.full(v.shape, 2**64 - 1, dtype=np.uint64),
    "half floats": lambda v, _: np.asarray(v).astype(np.float16),
}
"""Other numbers in the same shape, which a function may take or not."""

_KINDS: dict[str, Draw] = {
    "None": lambda v, _: None,
    "text": lambda v, _: "forces",
    "texts": lambda v, _: np.asarray(v).astype(str),
    "bytes": lambda v, _: b"12345678",
    "objects": lambda v, _: np.asarray(v).astype(object),
    "object": lambda v, _: object(),
    "None inside": _none_inside,
    "ragged": _ragged,
    "complex": lambda v, _: v + 1j,
    "dates": lambda v, _: np.full(v.shape, "2020-01-01", dtype="datetime64[D]"),
    "durations": lambda v, _: np.full(v.shape, 1, dtype="timedelta64[s]"),
    "records": lambda v, _: np.zeros(v.shape, dtype=[("x", float)]),
    "huge integers": lambda v, _: [2**70] * max(1, len(v)),
    "masked": _masked,
    "sparse": _sparse,
    "dict": lambda v, _: {"a": v},
    "set": lambda v, _: {1.0, 2.0},
    "function": lambda v, _: len,
    "iterator": lambda v, _: iter(v.tolist()),
    "foreign": lambda v, _: _Foreign(v.shape),
}
"""What holds no real numbers."""

MEMBERS: dict[str, tuple[str, Draw]] = {
    name: (family, draw)
    for family, draws in (("form", _FORMS), ("shape", _SHAPES), ("number", _NUMBERS), ("kind", _KINDS))
    for name, draw in draws.items()
}
"""Family and maker of each wrong argument, by its name."""


def complaint(call: Call, array: str, member: str, rng: np.random.Generator) -> str | None:
    """What is wrong with what a function makes of a wrong argument."""
    argument = call.arrays[array]
    family, draw = MEMBERS[member]
    given = draw(np.asarray(argument.value), rng)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            answer = call(**{array: given})
    except PlantarError as error:
        if family == "form":
            return f"the same numbers are refused: {error}"
        return _of_message(str(error), argument)
    except Exception as error:
        return f"raises {type(error).__name__}: {str(error)[:100]}"
    if family == "form":
        return None if same_answer(answer, call()) else "answers otherwise than to the same numbers"
    if (family == "kind" and not (given is None and argument.optional)) or not _may_answer(call, array, given, family):
        return f"answers {str(answer)[:60]!r}"
    return None


def _may_answer(call: Call, array: str, given: Any, family: str) -> bool:
    """Whether an argument is one that the function takes, by its shape and numbers."""
    argument = call.arrays[array]
    if given is None:
        return argument.optional
    values = np.asarray(given)
    if family == "shape":
        return call.taken(array, values.shape)
    return argument.nan or values.dtype.kind != "f" or bool(np.isfinite(values).all())


def _of_message(text: str, argument: Argument) -> str | None:
    if "\n" in text or len(text) > 400:
        return f"the error is no line: {text[:80]!r}"
    if not any(word in text.lower() for word in argument.called.split()):
        return f"the error does not name the argument ({argument.called}): {text[:100]}"
    return None


def same_answer(one: Any, other: Any) -> bool:
    """Whether two answers are the same to rounding, whatever they are made of: sums go in another order in memory."""
    a, b = list(_parts(one)), list(_parts(other))
    return len(a) == len(b) and all(_same_array(x, y) for x, y in zip(a, b, strict=True))


def _same_array(one: Array, other: Array) -> bool:
    if one.dtype != other.dtype or one.shape != other.shape:
        return False
    if one.dtype.kind != "f":
        return bool((one == other).all())
    near = _ROUNDING * float(np.abs(other[np.isfinite(other)]).max(initial=0.0))
    return bool(np.allclose(one, other, rtol=0.0, atol=near, equal_nan=True))


def _parts(answer: Any) -> Iterator[Array]:
    if isinstance(answer, Outline):
        answer = (answer.points, answer.starts)
    elif is_dataclass(answer):
        answer = [getattr(answer, f.name) for f in fields(answer)]
    if isinstance(answer, dict):
        answer = list(answer.items())
    if isinstance(answer, tuple | list):
        for item in answer:
            yield from _parts(item)
    elif isinstance(answer, np.ndarray):
        yield answer
    else:
        yield np.array(answer if isinstance(answer, int | float | np.generic) else repr(type(answer)))
