"""A robot as data: what its TOML states, checked."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.contact.foot_contacts import middle_of_sole
from plantar.layouts.layout import SoleLayout
from plantar.robots.biped import BipedParameters

# measured: feet of Unitree's H1 and of an Atlas of five joints a leg land with at most 0.87 and 1.05 weights where they
# are loaded in the middle, 0.57 and 0.96 at 0.5 of the way, 0.49 and 0.51 at 0.8, 0.42 and 0.39 at 1, where the last
# step's sole turns too far
_OUTWARD = 0.8


@dataclass(frozen=True)
class LegNames:
    """Names of one leg in the robot's model.

    Attributes:
        joints: From hip to ankle.
        foot_body: Body that wears the shoe.
        sole_site: Site that is the sole frame.
    """

    joints: tuple[str, ...]
    foot_body: str
    sole_site: str


@dataclass(frozen=True)
class FootShape:
    """The bare left foot as a rounded box, for the shoe builder.

    Attributes:
        length: In m.
        width: In m.
        center: (x, y) against ankle in m.
        corner_radius: In m.
        taxels: Number on sole.
    """

    length: float
    width: float
    center: tuple[float, float]
    corner_radius: float
    taxels: int


@dataclass(frozen=True)
class Arms:
    """Arms to wear in scenes with moving ones; else part of the chest.

    `machine`: name or TOML of machine that has them (`plantar.sim.companion.machine`), with the same base; `chest`:
    body whose mass, center and inertia include them; `roots`: first link of each arm in machine.
    """

    machine: str
    chest: str
    roots: Mapping[Side, str]


@dataclass(frozen=True, repr=False)
class Robot:
    """A robot as its TOML describes it.

    Attributes:
        kind: "biped" (generated from `biped`), "mjcf" or "urdf" (read from `model_file`).
        biped: Dimensions of a generated robot, else None.
        model_file: Path, else None.
        foot: Shape of bare foot, if given.
        shoe_thickness: Outer contact face below bare sole in m.
        shoe_mass: One shoe, in kg.
        rim_stiffness: Shoe next to its taxels over theirs; 0 with a relieved pad.
        contact_damping: Damping ratio of shoe on ground; 1 is critical.
        sole_origins: Sole origin (3,) in its body's frame in m.
        sole_rotations: Rotation (3, 3) from sole frame to body.
        effort_limits: Of each leg joint in N m, from a model file; empty for none.
        velocity_limits: In rad/s; empty for none.
        torso_body: Body that is kept upright.
        posture: Joint angles of each leg in rad when standing.
        com_height: Above the outer soles when walking in m.
        stance_width: Distance of sole origins with feet together in m.
        leg_length: From hip over knee to ankle in m, for shares; 0 for the model's.
        largest_crouch: How much below `com_height` it may walk in m.
        trunk_lean: Roll of torso over stance foot in rad per metre of lateral CoM motion.
        single_support: t_ss in s where the scene gives none; 0 for the same beats of leg for every robot.
        double_support: t_ds likewise.
        approach_support: Least t_ss in s of a walk with slow approach, for weak motors; else 0.
        ankle_reach: Largest distance in m from the sole's origin at which the ankle carries the robot.
        rocks: Whether legs without ankle roll rock from foot to foot: own timing, no slow approach.
        pace: Beats of leg in the time unit of quick steps (`plantar.common.settings.body_scale`).
        stiffness: Servo position gain of each leg joint in N m/rad.
        damping: Servo velocity gain in N m s/rad.
        own_stiffness: Position gain of each joint's own motor in N m/rad (`control.drives`).
        own_damping: Velocity gain in N m s/rad.
        controller: Settings of other parts by table and name (`plantar.gait.controller_tables`).
        arms: Arms that it may wear, or None.
    """

    name: str
    description: str
    kind: str
    biped: BipedParameters | None
    model_file: Path | None
    foot: FootShape | None
    shoe_thickness: float
    shoe_mass: float
    rim_stiffness: float
    contact_damping: float
    sole_origins: Mapping[Side, NDArray[np.float64]]
    sole_rotations: Mapping[Side, NDArray[np.float64]]
    effort_limits: tuple[float, ...]
    velocity_limits: tuple[float, ...]
    layouts: Mapping[Side, SoleLayout]
    legs: Mapping[Side, LegNames]
    torso_body: str
    imu_site: str
    posture: Mapping[Side, tuple[float, ...]]
    com_height: float
    stance_width: float
    leg_length: float
    largest_crouch: float
    trunk_lean: float
    single_support: float
    double_support: float
    approach_support: float
    ankle_reach: float
    rocks: bool
    pace: float
    stiffness: tuple[float, ...]
    damping: tuple[float, ...]
    own_stiffness: tuple[float, ...]
    own_damping: tuple[float, ...]
    balance: Mapping[str, Any]
    controller: Mapping[str, Mapping[str, Any]]
    path: Path
    arms: Arms | None = None

    def __repr__(self) -> str:
        return f"Robot({self.name!r}: {self.description})"

    @property
    def outward(self) -> float:
        """Share of the way from a sole's middle to its outer edge where it is loaded: one that rocks stands there."""
        return _OUTWARD if self.rocks else 0.0

    def middle_of_sole(self, side: Side) -> NDArray[np.float64]:
        """VRP (2,) over a whole foothold, sole frame, in m."""
        return middle_of_sole(self.layouts[side], self.ankle_reach, outward=self.outward)

    def sole_rectangle(self, side: Side) -> tuple[tuple[float, float], tuple[float, float]]:
        """A sole's bounding rectangle: center (x, y), half size (x, y), sole frame, in m."""
        outline = self.layouts[side].outline
        low = outline.min(axis=0)
        high = outline.max(axis=0)
        center = 0.5 * (low + high)
        half = 0.5 * (high - low)
        return (float(center[0]), float(center[1])), (float(half[0]), float(half[1]))
