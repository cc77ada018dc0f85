"""Ways to model a sole, and the contact parameters of its geoms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

__all__ = ["CANDIDATES", "Candidate", "Contact"]


@dataclass(frozen=True)
class Candidate:
    """One way to model a sole.

    Attributes:
        name: Short name, as in the tables.
        text: What it is, in a few words.
        kind: "box", "spheres" or "prisms": what touches the ground.
        count: Spheres a taxel.
        reading: "patches", "tactile" or "contacts": where taxel forces come from.
        fit: What a tactile reading is scaled to: "force" or "wrench".
    """

    name: str
    text: str
    kind: str = "box"
    count: int = 0
    reading: str = "contacts"
    fit: str = "wrench"


CANDIDATES: tuple[Candidate, ...] = (
    Candidate("box + patches", "one box; contact patches with the exact wrench (chosen)", reading="patches"),
    Candidate("box + tactile, fz", "one box; MuJoCo's tactile sensor scaled to fz", reading="tactile", fit="force"),
    Candidate("box + tactile, wrench", "one box; MuJoCo's tactile sensor scaled to fz, tx, ty", reading="tactile"),
    Candidate("1 sphere a taxel", "one sphere at each taxel's centre", "spheres", 1),
    Candidate("3 spheres a taxel", "three spheres at alternate corners, 75 % out", "spheres", 3),
    Candidate("7 spheres a taxel", "centre and six corners, 90 % out", "spheres", 7),
    Candidate("prism a taxel", "the cell's own polygon as a convex mesh", "prisms", 0),
    Candidate("box a taxel", "a square box of the cell's area", "prisms", 1),
)
"""What is compared; the first one is the simulator's own."""


class Contact(NamedTuple):
    """Contact parameters of all geoms; by default those recommended on stiff position servos."""

    time_constant: float = 0.005
    damping_ratio: float = 1.0
    impedance: tuple[float, ...] = (0.95, 0.99, 0.001, 0.5, 2.0)
    condim: int = 3
    cone: str = "elliptic"
    friction_ratio: float = 10.0
    friction: float = 0.8
    gap: float = 0.001

    def geom_attributes(self) -> str:
        """MJCF attributes of a geom."""
        impedance = " ".join(f"{v:g}" for v in self.impedance)
        return (
            f'solref="{self.time_constant:g} {self.damping_ratio:g}" solimp="{impedance}" condim="{self.condim}" '
            f'friction="{self.friction:g} 0.02 0.001" gap="{self.gap:g}"'
        )
