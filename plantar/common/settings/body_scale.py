"""Units that grow with a robot: body weight, leg, sole, beat of a swinging leg, pace.

Robots of one shape walk alike with the same shares of leg, weight and beats sqrt(leg / g) (Alexander, Int. J. Robotics
Research 3(2), 1984). Motors are not similar: a pace is the beats that a robot's motors need for a beat of others.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError


class _Symbol(NamedTuple):
    """Powers of kg, m and s in a unit's dimension, and its SI unit; "" if itself SI."""

    dimension: tuple[int, int, int]
    si: str = ""


_SYMBOLS: dict[str, _Symbol] = {  # nature: exponents of kg, m and s in each unit
    "1": _Symbol((0, 0, 0)),
    "rad": _Symbol((0, 0, 0)),
    "kg": _Symbol((1, 0, 0)),
    "m": _Symbol((0, 1, 0)),
    "s": _Symbol((0, 0, 1)),
    "N": _Symbol((1, 1, -2)),
    "Hz": _Symbol((0, 0, -1)),
    "mass": _Symbol((1, 0, 0), "kg"),
    "weight": _Symbol((1, 1, -2), "N"),
    "leg": _Symbol((0, 1, 0), "m"),
    "sole": _Symbol((0, 1, 0), "m"),
    "sole_width": _Symbol((0, 1, 0), "m"),
    "beat": _Symbol((0, 0, 1), "s"),
    "pace": _Symbol((0, 0, 1), "s"),
}

BODY_UNITS = tuple(name for name, symbol in _SYMBOLS.items() if symbol.si)
"""Names of the units that grow with a robot."""

_FACTOR = re.compile(r"([A-Za-z_]+|1)(?:\^(\d))?")
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})(?:/({_NUMBER}))?\s+(\S.*?)\s*")


@lru_cache(maxsize=512)
def _factors(unit: str) -> tuple[tuple[str, int], ...]:
    """Symbols of a unit such as "rad/beat/weight/leg" with their powers."""
    found: list[tuple[str, int]] = []
    sign = 1
    for part in re.split(r"([/ ])", unit):
        if part in ("/", " ", ""):
            sign = -1 if part == "/" else sign
            continue
        match = _FACTOR.fullmatch(part)
        if match is None or match[1] not in _SYMBOLS:
            raise InputError(f"no unit '{part}'; known: {', '.join(_SYMBOLS)}")
        found.append((match[1], sign * int(match[2] or 1)))
        sign = 1
    return tuple(found)


@lru_cache(maxsize=512)
def _dimension(unit: str) -> tuple[int, ...]:
    return tuple(sum(_SYMBOLS[name].dimension[k] * power for name, power in _factors(unit)) for k in range(3))


def si_unit(unit: str) -> str:
    """A unit with SI units in place of the body's.

    Example:
        >>> si_unit("rad/beat/weight/leg"), si_unit("weight")
        ('rad/s/N/m', 'N')
    """
    _factors(unit)
    return re.sub(r"[A-Za-z_]+", lambda m: _SYMBOLS[m[0]].si or m[0], unit)


@dataclass(frozen=True)
class BodyScale:
    """Size of a robot, for its shares.

    `mass` in kg; `leg` from hip over knee to ankle in m; `sole`: length in m; `sole_width` in m; `pace_beats`: beats of
    a pace: 1, or more for slow motors.

    Example:
        >>> body = BodyScale(mass=33.0, leg=0.5, sole=0.2, sole_width=0.1)
        >>> body.in_si("leg"), round(body.in_si("weight"), 2), round(body.in_si("leg/beat"), 3)
        (0.5, 323.73, 2.215)
    """

    mass: float
    leg: float
    sole: float
    sole_width: float
    pace_beats: float = 1.0  # nature: a pace is a beat where motors are as quick as those of others

    def __post_init__(self) -> None:
        for name, value in self.__dict__.items():
            if not 0.0 < value < math.inf:
                raise InputError(f"{name} of a body is {value!r}; allowed: a finite number above 0")

    @property
    def weight(self) -> float:
        """Body weight m g in N."""
        return self.mass * GRAVITY

    @property
    def beat(self) -> float:
        """sqrt(leg / g) in s, a leg's time scale under gravity."""
        return math.sqrt(self.leg / GRAVITY)

    @property
    def pace(self) -> float:
        """Time in s that the motors need for a beat of others."""
        return self.pace_beats * self.beat

    def in_si(self, unit: str) -> float:
        """SI units in a unit of body or SI, such as "leg/s"; else InputError."""
        value = 1.0
        for name, power in _factors(unit):
            value *= (getattr(self, name) if name in BODY_UNITS else 1.0) ** power
        return value


REFERENCE_BODY = BodyScale(mass=86.0, leg=0.6, sole=0.25, sole_width=0.159)
"""The body that settings count for as long as nobody says which it is: the robot `h1`. Nature: the robot `h1` of T and
K, as its file states it."""


@dataclass(frozen=True)
class Quantity:
    """A number with its unit.

    Example:
        >>> Quantity.parsed("1/3 leg").si(REFERENCE_BODY)
        0.19999999999999998
        >>> str(Quantity(0.083, "weight"))
        '0.083 weight'
    """

    value: float
    unit: str

    @classmethod
    def parsed(cls, text: str) -> Quantity | None:
        """A quantity from a text such as "0.083 weight" or "1/3 leg"; None unless it begins with a
        number and a space.
        """
        match = _QUANTITY.fullmatch(text)
        if match is None or (match[2] is not None and float(match[2]) == 0.0):
            return None
        _factors(match[3])
        return cls(float(match[1]) / float(match[2] or 1.0), match[3])

    def is_a(self, unit: str) -> bool:
        """Whether it has the dimension of a unit."""
        return _dimension(self.unit) == _dimension(unit)

    def si(self, body: BodyScale) -> float:
        """The number in SI for a body."""
        return self.value * body.in_si(self.unit)

    def __str__(self) -> str:
        return f"{self.value:.4g} {self.unit}"
