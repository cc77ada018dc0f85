"""Values of a setting as canonical texts (1.0 is 1), and ranges."""

import json
import math
import re
from dataclasses import dataclass
from typing import Any

from plantar.common.files.structured_text import parse_toml
from plantar.errors import InputError

_OPENING = ("[", "{", '"', "'")  # what a value begins with that may hold commas


def split_values(text: str) -> list[str]:
    """TOML values and bare words of a list, split at outer commas.

    Example:
        >>> split_values("[1, 2], [3, 4]")
        ['[1, 2]', '[3, 4]']
    """
    values: list[str] = []
    part = None
    for piece in text.split(","):
        part = piece if part is None else f"{part},{piece}"
        value = part.strip()
        if value[:1] not in _OPENING or _parsed(value) is not None:
            values.append(value)
            part = None
    if part is not None:
        raise InputError(f"values '{text}' have one that is not closed, or no valid TOML: {part.strip()}")
    if "" in values:
        raise InputError(f"values '{text}' have an empty one; allowed: a,b,c")
    return values


def is_word(key: str) -> bool:
    """Whether a setting takes its text unchanged: a name or a path."""
    return key in ("robot", "machine", "kind", "terrain.kind")


def canonical(text: str, *, word: bool = False) -> str:
    """Returns the one text for TOML values or bare words `text` of one meaning; a `word` only loses quotes.

    Example:
        >>> [canonical(text) for text in ("1.0", "0.10", "[1,2]", "'left'", "left", '"1"')]
        ['1', '0.1', '[1, 2]', 'left', 'left', '"1"']
    """
    text = text.strip()
    if not text.isprintable():
        raise InputError(f"value {text!r} is not of printable characters")
    value = _parsed(text)
    if value is None and text[:1] in _OPENING:
        raise InputError(f"value '{text}' is not valid TOML")
    if word:
        return value if isinstance(value, str) else text
    return text if value is None else _written(value, bare=True)


def _parsed(text: str) -> Any:
    try:
        return parse_toml(f"v = {text}")["v"]
    except ValueError:
        return None


def _written(value: Any, bare: bool = False) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))  # wherever a setting takes a number, a whole one means the same as its float
    if isinstance(value, str):
        plain = bare and value == value.strip() != "" and value.isprintable() and _parsed(value) is None
        return value if plain and value[0] not in _OPENING else json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{json.dumps(k, ensure_ascii=False)} = {_written(v)}' for k, v in value.items())}}}"
    return str(value)


_STEPS = 1000  # at least so many values are distinguished
_END = re.compile(r"\s*(?P<number>[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?)\s*(?P<unit>[^\d\s].*)?", re.IGNORECASE)


@dataclass(frozen=True)
class ValueRange:
    """The range of a searched setting.

    `unit`: share of a body in which both are given, such as "sole", or empty; `whole`: whether only whole numbers are
    tried.

    Example:
        >>> ValueRange.from_text("width=0.2 sole:0.6 sole", "limit").text(0.41237)
        '0.4124 sole'
    """

    name: str
    low: float
    high: float
    unit: str = ""
    whole: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise InputError(f"range of '{self.name}' is {self.low:g} to {self.high:g}; allowed: a smaller one first")

    @classmethod
    def from_text(cls, text: str, option: str) -> "ValueRange":
        """Returns the range of `text` "key=from:to" of `option`; both ends may be shares of one unit."""
        key, equals, ends = text.partition("=")
        found = [_END.fullmatch(end) for end in ends.split(":")]
        if not equals or not key.strip() or len(found) != 2 or found[0] is None or found[1] is None:
            raise InputError(f"{option} {text!r} is not of the form key=from:to, two numbers")
        low = found[0]
        high = found[1]
        units = [(end["unit"] or "").strip() for end in (low, high)]
        if units[0] != units[1]:
            raise InputError(f"{option} {text!r} has two units; allowed: the same one twice, or none")
        return cls(key.strip(), float(low["number"]), float(high["number"]), units[0])

    def rounded(self, value: float) -> float:
        """The nearest value that is tried, within the range."""
        exponent = 0 if self.whole else math.floor(math.log10((self.high - self.low) / _STEPS))
        whole = round(min(max(value, self.low), self.high) / 10.0**exponent) * 10.0**exponent
        near = min(max(whole, self.low), self.high)  # an end that is no multiple of the step is tried as it is
        # Through its text: the same value whichever way it was computed.
        return float(f"{near:.15g}")

    def text(self, value: float) -> str:
        """The nearest value that is tried, as a setting's text."""
        number = self.rounded(value)
        plain = canonical(f"{number:.15g}")
        return f"{plain} {self.unit}" if self.unit else plain

    def value(self, text: str) -> float:
        """The number of a text that `text` gave."""
        return float(text.split()[0])
