"""The foam of a skin that presses back."""

from dataclasses import dataclass

from plantar.common.arguments import number, positive
from plantar.errors import InputError


@dataclass(frozen=True)
class Foam:
    """An elastic foundation over a skin's taxels (Winkler's): each yields for itself.

    Pressure on a taxel is stiffness times depth plus damping times its rate, never below zero; friction is Coulomb's.

    Attributes:
        stiffness: Pressure per depth in Pa/m; by default 10 mm of 100 kPa foam.
            `ElasticLayer(modulus, thickness).stiffness` is that of a layer.
        damping: Pressure per speed in Pa s/m.
        friction: Coulomb's coefficient.
        slip_speed: Sliding speed in m/s at which friction reaches 71 % of Coulomb's.

    Raises:
        InputError: If a value is not allowed.

    Source: Johnson, Contact mechanics (1985), 4.3.
    """

    stiffness: float = 1e7
    damping: float = 3e4
    friction: float = 0.5
    slip_speed: float = 0.02

    def __post_init__(self) -> None:
        positive(self.stiffness, "stiffness", "Pa/m")
        positive(self.slip_speed, "slip speed", "m/s")
        for name, unit in (("damping", "Pa s/m"), ("friction", "")):
            if number(getattr(self, name), name, finite=True) < 0.0:
                raise InputError(f"{name} is {getattr(self, name)} {unit}".rstrip() + "; allowed: 0 or more")
