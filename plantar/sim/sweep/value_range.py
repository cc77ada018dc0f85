"""The range of a searched setting."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from plantar.errors import InputError
from plantar.sim.sweep.grid import canonical

__all__ = ["ValueRange"]

_STEPS = 1000  # at least so many values are distinguished
_END = re.compile(r"\s*(?P<number>[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?)\s*(?P<unit>[^\d\s].*)?", re.IGNORECASE)


@dataclass(frozen=True)
class ValueRange:
    """The range of a searched setting.

    Attributes:
        name: The setting.
        low: Smallest value.
        high: Largest value.
        unit: Share of a body in which both are given, such as "sole", or empty.
        whole: Whether only whole numbers are tried.

    Raises:
        InputError: If the range is empty or not finite.

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
    def from_text(cls, text: str, option: str) -> ValueRange:
        """Returns the range of `text` "key=from:to" of a command's `option`; both ends may be shares of the same unit.

        Raises:
            InputError: If the text is malformed, or the range empty.
        """
        key, equals, ends = text.partition("=")
        found = [_END.fullmatch(end) for end in ends.split(":")]
        if not equals or not key.strip() or len(found) != 2 or found[0] is None or found[1] is None:
            raise InputError(f"{option} {text!r} is not of the form key=from:to, two numbers")
        low, high = found[0], found[1]
        units = [(end["unit"] or "").strip() for end in (low, high)]
        if units[0] != units[1]:
            raise InputError(f"{option} {text!r} has two units; allowed: the same one twice, or none")
        return cls(key.strip(), float(low["number"]), float(high["number"]), units[0])

    def rounded(self, value: float) -> float:
        """The nearest value that is tried, within the range."""
        exponent = 0 if self.whole else math.floor(math.log10((self.high - self.low) / _STEPS))
        # Through its text: the same value whichever way it was computed.
        return float(self._digits(min(max(value, self.low), self.high), exponent))

    def text(self, value: float) -> str:
        """The nearest value that is tried, as a setting's text."""
        number = self.rounded(value)
        plain = canonical(f"{number:.15g}")
        return f"{plain} {self.unit}" if self.unit else plain

    def value(self, text: str) -> float:
        """The number of a text that `text` gave."""
        return float(text.split()[0])

    def _digits(self, value: float, exponent: int) -> str:
        rounded = round(value / 10.0**exponent) * 10.0**exponent
        near = min(max(rounded, self.low), self.high)  # an end that is no multiple of the step is tried as it is
        return f"{near:.{max(-exponent, 0) + 2}g}" if near == 0.0 else f"{near:.15g}"
