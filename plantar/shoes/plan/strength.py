"""Strength of the printed part under 1.5 x body weight on a third of the sole: p = load_factor m g / (load_share A)
from below.

Beams of 1 mm width, without ribs and wall, so on the safe side:

- beyond the foot, over a reach c: a cantilever, M = p c^2 / 2
- between two places where the foot touches, over a span L: a beam with clamped ends, M = p L^2 / 12
- the wall, pushed sideways with `friction` times the load over the foot's width b, at a third of its height h: M =
  friction F / b x h / 3, across the layers

Stress is 6 M / t^2, allowed the material's strength over `safety`.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from plantar.mechanics.lip import GRAVITY
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters

_MOST_MASS = 150.0  # kg: what a robot is estimated to weigh at most


@dataclass(frozen=True)
class LoadCase:
    """Load. `mass`: robot's in kg; `force`: load in N; `pressure` on its share of the sole, in MPa."""

    mass: float
    source: str
    force: float
    pressure: float


@dataclass(frozen=True)
class Member:
    """Loaded member: lengths in mm, stresses in MPa, deflection of its end or middle in mm."""

    name: str
    model: str
    length: float
    thickness: float
    needed: float
    stress: float
    allowed: float
    deflection: float

    @property
    def holds(self) -> bool:
        return self.stress <= self.allowed * (1.0 + 1e-9)


def estimated_mass(length: float) -> float:
    """Mass in kg of a robot with feet of a length in mm, scaled by volume.

    Seven humanoids of 3 to 95 kg, scaled to feet of 224 mm, weigh 17 to 112 kg, 50 in the geometric mean.

    Example:
        >>> estimated_mass(224.0)
        60.0
    """
    return round(min(_MOST_MASS, 60.0 * (length / 224.0) ** 3), 1)


def mass_range(length: float) -> tuple[float, float]:
    """Least and greatest mass in kg of the humanoids that `estimated_mass` rests on, scaled to feet of a length in mm.

    Example:
        >>> mass_range(224.0)
        (17.0, 112.0)
    """
    scale = (length / 224.0) ** 3
    return float(f"{17.0 * scale:.3g}"), float(f"{112.0 * scale:.3g}")


def load_case(foot: Foot, parameters: ShoeParameters) -> LoadCase:
    """Gives one foot's load: parameters may state the robot's mass."""
    p = parameters
    low, _, high, _ = foot.sole.bounds
    if p.robot_mass > 0.0:
        mass = p.robot_mass
        source = "as given"
    elif foot.mass is not None:
        mass = foot.mass
        source = "of the robot's file"
    else:
        mass = estimated_mass(high - low)
        least, most = mass_range(high - low)
        source = f"estimated from the foot's length, {least:g} to {most:g} kg; parameter robot_mass gives it"
    force = p.load_factor * mass * GRAVITY
    return LoadCase(mass, source, round(force, 1), force / (p.load_share * foot.sole.area))


def check_strength(foot: Foot, contact: Any, parameters: ShoeParameters) -> tuple[LoadCase, tuple[Member, ...]]:
    """Gives load and stresses in plate and wall of a foot with a contact face, by parameters."""
    p = parameters
    material = parameters.printed
    load = load_case(foot, p)
    allowed = material.strength / p.safety
    reach = float(max(foot.sole.distance(shapely.points(ring(contact)))))
    span = _unsupported_span(foot)
    push = p.friction * load.force / (foot.sole.bounds[3] - foot.sole.bounds[1])
    pressure = load.pressure
    lever = p.rim_height / 3.0

    def member(name: str, model: str, length: float, moment: float, at: float, limit: float, bent: float) -> Member:
        needed = math.ceil(1e3 * math.sqrt(6.0 * moment / limit) - 1e-6) / 1e3  # never rounded below what it takes
        deflection = bent / (material.modulus * at**3 / 12.0)
        figures = (length, at, needed, 6.0 * moment / at**2, limit, deflection)
        return Member(name, model, *(round(v, 3) for v in figures))

    return load, (
        member(
            "plate beyond the foot", "cantilever", reach, 0.5 * pressure * reach**2, p.floor, allowed,
            pressure * reach**4 / 8.0,
        ),
        member(
            "plate where the foot does not touch", "beam with clamped ends", span, pressure * span**2 / 12.0, p.floor,
            allowed, pressure * span**4 / 384.0,
        ),
        member(
            "wall", "cantilever across the layers", p.rim_height, push * lever, p.rim_thickness,
            allowed * material.across, push * lever**2 * (3.0 * p.rim_height - lever) / 6.0,
        ),
    )  # fmt: skip


def _unsupported_span(foot: Foot) -> float:
    if foot.support is None or foot.support.is_empty:
        return 0.0
    free = foot.sole.difference(foot.support)
    best = 0.0
    for part in getattr(free, "geoms", [free]):
        if part.geom_type == "Polygon" and part.area > 1.0:
            best = max(best, 2.0 * float(shapely.maximum_inscribed_circle(part, tolerance=0.1).length))
    return best


def strengthened(foot: Foot, contact: Any, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters with floor and wall raised by 0.1 mm until they carry the load of a foot with a contact face,
    and notes.
    """
    if parameters.strengthen == "no":
        return parameters, ()
    _, members = check_strength(foot, contact, parameters)
    floor = max(m.needed for m in members if m.name.startswith("plate"))
    wall = next(m.needed for m in members if m.name == "wall")
    notes: list[str] = []
    raised: dict[str, Any] = {}
    for name, needed in (("floor", floor), ("rim_thickness", wall)):
        _, high, _, _ = ShoeParameters.range_of(name)
        wanted = min(high, float(np.ceil(needed * 10.0 - 1e-6)) / 10.0)
        if wanted > getattr(parameters, name):
            notes.append(f"{name} raised from {getattr(parameters, name):g} to {wanted:g} mm by the load case")
            raised[name] = wanted
    return replace(parameters, **raised), tuple(notes)
