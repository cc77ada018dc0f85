"""Solids, motion and planned footprints of all kinds of ground.

A kind is a frozen dataclass of a scene's `[terrain]` table that turns footprints and a random generator into a
`Ground`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number, text
from plantar.layouts.layout import Side

GROUND_GROUP = 2
"""Geom group of all ground, and only of ground: what proximity sensors see."""

GROUND_CONTACT = 2
"""MuJoCo's bit of contacts with the ground."""

FLAT = ("box", "cylinder")
"""Shapes with flat faces, which soles touch as meshes of their corners."""

CORNERS = "_corners"
"""How the name of such a mesh ends; without that it is the name of the shape that is seen."""

_SIDES = 24  # of the prism that a cylinder is touched as: its corners are on the circle
_UNSEEN = 4  # geom group that pictures and proximity leave out
_FIELD_BASE = 0.05  # m of a field's body below its lowest level
_LEVEL = 0.9999  # cosine of the tilt up to which a face is level
_SAME_HEIGHT = 1e-4  # m up to which faces are at one height


@dataclass(frozen=True)
class Footprint:
    """Planned place of a sole.

    Attributes:
        center: Of the sole's rectangle (2,) in the world in m.
        yaw: Heading in rad.
        half: Half length and half width in m.
        ankle: Sole frame's origin (2,) in the world in m.
        lift_off: Planned in s; -inf for a foot that stands at the start.
        touchdown: Planned in s.
        z: Planned height in m.
    """

    side: Side
    center: NDArray[np.float64]
    yaw: float
    half: tuple[float, float]
    ankle: NDArray[np.float64]
    lift_off: float = -math.inf
    touchdown: float = -math.inf
    z: float = 0.0

    def place(self, along: float, across: float) -> NDArray[np.float64]:
        """Returns the point (2,) in the world, `along` forward and `across` left of the centre in m."""
        c = math.cos(self.yaw)
        s = math.sin(self.yaw)
        return np.asarray(self.center + np.array([c * along - s * across, s * along + c * across]))


@dataclass(frozen=True)
class PlannedFeet:
    """Planned footprints: of each foot `standing` at the start, and of `steps` in order."""

    standing: Mapping[Side, Footprint]
    steps: tuple[Footprint, ...]

    def middle(self, last: bool = False) -> NDArray[np.float64]:
        """Middle (2,) in m between soles' centres at the start, or with `last` at the end."""
        feet = dict(self.standing)
        if last:
            for step in self.steps:
                feet[step.side] = step
        return np.asarray(0.5 * (feet["left"].center + feet["right"].center))


@dataclass(frozen=True)
class Motion:
    """A move of a solid at constant speed.

    `start`: time in s; `duration` in s; 0 jumps; `position`: final centre (3,) in m.
    """

    start: float
    duration: float
    position: NDArray[np.float64]


@dataclass(frozen=True)
class Solid:
    """A piece of ground.

    Attributes:
        shape: "box", "sphere", "ellipsoid", "cylinder" (along z) or "field" of heights.
        size: Half sizes (3,) in m; radius; radius and half height; a field's half sizes and largest height.
        position: Centre (3,) in the world in m; of a field's lowest level.
        rotation: (3, 3) to the world.
        motions: In order of time.
        heights: Of a field (rows along y, columns along x) in m, 0 or more.
    """

    shape: str
    size: tuple[float, float, float]
    position: NDArray[np.float64]
    rotation: NDArray[np.float64] = field(default_factory=lambda: np.eye(3))
    motions: tuple[Motion, ...] = ()
    heights: NDArray[np.float64] | None = None

    def at(self, time: float) -> NDArray[np.float64]:
        """Centre (3,) in the world in m at a time."""
        position = self.position
        for motion in self.motions:
            if time < motion.start:
                break
            share = 1.0 if motion.duration <= 0.0 else min(1.0, (time - motion.start) / motion.duration)
            position = position + share * (motion.position - position)
        return position

    @property
    def top(self) -> float:
        """Largest height in m of any part, ever."""
        up = np.abs(self.rotation[2])
        a, b, c = self.size
        reach = {
            "box": up @ self.size,
            "sphere": a,
            "ellipsoid": np.linalg.norm(up * self.size),
            "cylinder": math.hypot(up[0], up[1]) * a + up[2] * b,
            "field": c,
        }
        return float(reach[self.shape]) + max(
            float(place[2]) for place in (self.position, *(m.position for m in self.motions))
        )


@dataclass(frozen=True)
class Ground:
    """Geometry of a ground.

    Attributes:
        solids: Its pieces.
        floor: Height in m of the plane below.
        friction: Sliding coefficient of sole on ground.
        facts: Random choices.
    """

    solids: tuple[Solid, ...]
    floor: float
    friction: float
    facts: Mapping[str, float] = field(default_factory=dict)

    def seen_from_above(self) -> list[list[list[float]]]:
        """Corners [[x, y], ...] in the world in m of solids' upper faces; round ones are 16-gons."""
        rings = []
        turns = np.linspace(0.0, 2.0 * math.pi, 17)[:-1]
        for solid in self.solids:
            if solid.shape in ("box", "field"):
                a, b, c = solid.size
                corners = np.array([[a, b, c], [-a, b, c], [-a, -b, c], [a, -b, c]]) @ solid.rotation.T
            else:
                radius = solid.size[0]
                corners = radius * np.column_stack([np.cos(turns), np.sin(turns), np.zeros(16)])
            rings.append(np.round(corners[:, :2] + solid.position[:2], 5).tolist())
        return rings

    @property
    def moving(self) -> tuple[tuple[int, Solid], ...]:
        """Moving solids with their number."""
        return tuple((i, s) for i, s in enumerate(self.solids) if s.motions)

    def level_at(self, height: float) -> bool:
        """Whether all pieces have level faces at a `height` in m: beams and stones, not steps or slopes."""
        flat = all(s.shape == "box" and s.rotation[2, 2] > _LEVEL and not s.motions for s in self.solids)
        return flat and all(abs(solid.top - height) < _SAME_HEIGHT for solid in self.solids)

    @property
    def top(self) -> float:
        """Largest height in m of any part, ever."""
        return max([self.floor, *(solid.top for solid in self.solids)])

    def add_to(self, spec: Any) -> None:
        """Add floor geom "ground" and solids "ground_0", "ground_1"... to a `mujoco.MjSpec`.

        Boxes and cylinders are seen as they are and touched as meshes of their corners, "ground_0_corners"...
        """
        import mujoco

        kinds = {
            "box": mujoco.mjtGeom.mjGEOM_BOX,
            "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
            "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
            "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
            "field": mujoco.mjtGeom.mjGEOM_HFIELD,
        }
        touched = {"contype": GROUND_CONTACT, "conaffinity": 1, "friction": [self.friction, 0.005, 0.0001]}
        floor = {"size": [0.0, 0.0, 1.0], "pos": [0.0, 0.0, self.floor], "material": "ground"}
        spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, group=GROUND_GROUP, **floor, **touched)
        places = [_placed(spec, i, solid) for i, solid in enumerate(self.solids)]
        for i, (solid, (body, place)) in enumerate(zip(self.solids, places, strict=True)):
            body.add_geom(
                name=f"ground_{i}",
                type=kinds[solid.shape],
                group=GROUND_GROUP,
                rgba=[0.72, 0.66, 0.55, 1.0] if i % 2 else [0.62, 0.68, 0.60, 1.0],
                **place,
                **_shape(spec, i, solid),
                **({"contype": 0, "conaffinity": 0} if solid.shape in FLAT else touched),
            )
        _use_many_contacts(spec)
        meshes: dict[tuple[str, tuple[float, ...]], str] = {}
        for i, (solid, (body, place)) in enumerate(zip(self.solids, places, strict=True)):
            if solid.shape in FLAT:
                mesh = meshes.setdefault((solid.shape, solid.size), f"ground_{i}{CORNERS}")
                if mesh.startswith(f"ground_{i}_"):
                    spec.add_mesh(name=mesh, uservert=_corners(solid).ravel().tolist())
                body.add_geom(
                    name=f"ground_{i}{CORNERS}",
                    type=mujoco.mjtGeom.mjGEOM_MESH,
                    meshname=mesh,
                    group=_UNSEEN,
                    **place,
                    **touched,
                )


def _placed(spec: Any, number: int, solid: Solid) -> tuple[Any, dict[str, Any]]:
    """Body of a solid, and its place in it."""
    import mujoco

    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, solid.rotation.ravel())
    place = {"pos": solid.position.tolist(), "quat": quaternion.tolist()}
    if not solid.motions:
        return spec.worldbody, place
    return spec.worldbody.add_body(name=f"ground_{number}", mocap=True, **place), {}


def _shape(spec: Any, number: int, solid: Solid) -> dict[str, Any]:
    if solid.heights is None:
        return {"size": list(solid.size)}
    rows, columns = solid.heights.shape
    field = spec.add_hfield(
        name=f"ground_{number}",
        nrow=rows,
        ncol=columns,
        size=[*solid.size[:2], max(solid.size[2], 1e-6), _FIELD_BASE],
        userdata=solid.heights.ravel().tolist(),
    )
    return {"size": [0.0, 0.0, 0.0], "hfieldname": field.name}


def _corners(solid: Solid) -> NDArray[np.float64]:
    """Corners (k, 3) in m of a box, or of a prism in place of a cylinder."""
    if solid.shape == "box":
        return np.array(list(product((-1.0, 1.0), repeat=3))) * solid.size
    radius, half, _ = solid.size
    turns = 2.0 * math.pi * np.arange(_SIDES) / _SIDES
    ring = radius * np.column_stack([np.cos(turns), np.sin(turns)])
    return np.concatenate([np.column_stack([ring, np.full(_SIDES, z)]) for z in (-half, half)])


def _use_many_contacts(spec: Any) -> None:
    """Let MuJoCo find several contacts of a pair of convex shapes: before MuJoCo 4 that has to be asked for."""
    import mujoco

    spec.option.enableflags |= int(getattr(mujoco.mjtEnableBit, "mjENBL_MULTICCD", 0))


class Terrain(Settings):
    """Common settings of all kinds of ground.

    Attributes:
        kind: Name of the kind.
        friction: Sliding coefficient of sole on ground.
        height: Ground height in m at the start, as planned.
    """

    kind: str = text("flat")
    friction: float = number(0.8, "1", 0.05, 5)
    height: float = number(0.0, "m", -10, 10)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        """Returns the ground for planned `feet`, with choices drawn from `rng`; each kind defines it."""
        raise NotImplementedError(f"{type(self).__name__} needs a method `ground(feet, rng)`")


class Flat(Terrain):
    """An endless level plane."""

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        return Ground((), self.height, self.friction)
