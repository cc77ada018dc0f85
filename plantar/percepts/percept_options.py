"""Options of a percept beyond layout and reading."""

from dataclasses import dataclass

from plantar.common.arguments import number, positive
from plantar.errors import InputError
from plantar.sensing.proximity import contour_levels

PROXIMITY_GAIN = 50.0
"""Repulsion k_p of a taxel in N/m (T 4.26): 42 taxels with a range of 50 mm push with up to 105 N. Chosen: K p of T
4.26 is not printed; this makes 42 taxels at their range push with 105 N, a foot's touch."""

CONTOUR_HEIGHTS: tuple[float, ...] = (0.01, 0.02, 0.03, 0.04, 0.05)
"""Heights in m of the contours of the ground (T 4.2.7). Nature: five even parts of the range of 50 mm of T 4.2.1."""


@dataclass(frozen=True)
class PerceptOptions:
    """Options of a percept, shared by a recording's percepts.

    Attributes:
        fill: Replace faulty taxels by their sound neighbours' pressure, not leaving them out.
        proximity_gain: Repulsion k_p of a taxel in N/m (T 4.26).
        contour_heights: Heights of ground contours in m (T 4.2.7), kept lowest first.
        reference_area: Area xi in m^2 of pressure-driven wrench (T 3.27); one cell's if None.

    Raises:
        InputError: Not finite.
    """

    fill: bool = False
    proximity_gain: float = PROXIMITY_GAIN
    contour_heights: tuple[float, ...] = CONTOUR_HEIGHTS
    reference_area: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.fill, bool):
            raise InputError(f"option 'fill' is {self.fill!r}; allowed: True or False")
        object.__setattr__(self, "proximity_gain", number(self.proximity_gain, "proximity gain", finite=True))
        object.__setattr__(self, "contour_heights", contour_levels(self.contour_heights))
        if self.reference_area is not None:
            object.__setattr__(self, "reference_area", positive(self.reference_area, "reference area", "m^2"))
