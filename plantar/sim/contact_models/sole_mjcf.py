"""Contact models and parameters, and a sole's MJCF: its outer face is z = 0."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout


@dataclass(frozen=True)
class Candidate:
    """One way to model a sole.

    `kind`: "box", "spheres" or "prisms": what touches the ground; `reading`: "patches", "tactile" or "contacts": where
    taxel forces come from; `fit`: what a tactile reading is scaled to: "force" or "wrench".
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
    """Contact parameters of all geoms; defaults for stiff position servos."""

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


SOLE_THICKNESS = 0.02  # m
_PRISM_DEPTH = 0.01  # m
SPHERE_RADIUS = 0.004
"""Radius in m of the spheres of a sole on spheres."""


class SoleMjcf(NamedTuple):
    """MJCF under <asset>, in the foot's body, and under <sensor>."""

    assets: str
    geoms: str
    sensors: str = ""


def bounding_rectangle(layout: SoleLayout) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Middle (2,) and half size (2,) in m of a `layout`'s outline."""
    low = layout.outline.min(axis=0)
    high = layout.outline.max(axis=0)
    return 0.5 * (low + high), 0.5 * (high - low)


def sole_mjcf(candidate: Candidate, layout: SoleLayout, attributes: str) -> SoleMjcf:
    """Returns the MJCF of a `layout` by a contact model `candidate`, with `attributes` of touching geoms."""
    make = _MAKERS.get((candidate.kind, candidate.reading))
    if make is None or (candidate.kind == "spheres" and candidate.count < 1):
        raise InputError(f"contact model {candidate.name!r} has an unknown kind or reading; allowed: see CANDIDATES")
    return make(candidate, layout, attributes)


def _box(candidate: Candidate, layout: SoleLayout, attributes: str) -> SoleMjcf:
    (cx, cy), (hx, hy) = bounding_rectangle(layout)
    h = 0.5 * SOLE_THICKNESS
    place = f'size="{hx} {hy} {h}" pos="{cx} {cy} {h}"'
    return SoleMjcf("", f'<geom name="left_sole_box" type="box" {place} {attributes}/>')


def _box_with_tactile_sensor(candidate: Candidate, layout: SoleLayout, attributes: str) -> SoleMjcf:
    from scipy.spatial import Delaunay  # only for the tactile sensor's mesh

    points = _numbers(np.column_stack([layout.positions[:, :2], np.zeros(len(layout))]))
    faces = " ".join(map(str, Delaunay(layout.positions[:, :2]).simplices.ravel().tolist()))
    mesh = f'<mesh name="taxels" inertia="shell" vertex="{points}" face="{faces}"/>'
    # The sensor takes the points in the frame of its geom: a geom of the same mesh puts them where they are.
    skin = '<geom name="left_taxels" type="mesh" mesh="taxels" contype="0" conaffinity="0" mass="0"/>'
    box = _box(candidate, layout, attributes).geoms
    return SoleMjcf(mesh, box + skin, '<tactile name="left_taxels" geom="left_taxels" mesh="taxels"/>')


def _spheres(candidate: Candidate, layout: SoleLayout, attributes: str) -> SoleMjcf:
    r = SPHERE_RADIUS
    parts = [
        f'<geom name="taxel{i}_{j}" type="sphere" size="{r}" pos="{x} {y} {r}" {attributes}/>'
        for i in range(len(layout))
        for j, (x, y) in enumerate(support_points(layout.cell_polygon(i), candidate.count))
    ]
    return SoleMjcf("", "".join(parts))


def _prisms(candidate: Candidate, layout: SoleLayout, attributes: str) -> SoleMjcf:
    if candidate.count > 0:
        return SoleMjcf("", "".join(_square(layout, i, attributes) for i in range(len(layout))))
    rings = [layout.cell_polygon(i) for i in range(len(layout))]
    corners = [np.vstack([np.column_stack([r, np.full(len(r), z)]) for z in (0.0, _PRISM_DEPTH)]) for r in rings]
    meshes = [f'<mesh name="taxel{i}" vertex="{_numbers(c)}"/>' for i, c in enumerate(corners)]
    parts = [f'<geom name="taxel{i}_0" type="mesh" mesh="taxel{i}" {attributes}/>' for i in range(len(layout))]
    return SoleMjcf("".join(meshes), "".join(parts))


def _square(layout: SoleLayout, i: int, attributes: str) -> str:
    half = 0.5 * float(np.sqrt(layout.areas[i]))
    x, y = layout.positions[i, :2]
    depth = 0.5 * _PRISM_DEPTH
    return f'<geom name="taxel{i}_0" type="box" size="{half} {half} {depth}" pos="{x} {y} {depth}" {attributes}/>'


# What makes the MJCF of a candidate, by its kind and reading
_MAKERS: dict[tuple[str, str], Callable[[Candidate, SoleLayout, str], SoleMjcf]] = {
    ("box", "patches"): _box,
    ("box", "tactile"): _box_with_tactile_sensor,
    ("spheres", "contacts"): _spheres,
    ("prisms", "contacts"): _prisms,
}


def support_points(ring: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """Returns `count` points (count, 2) in m of a cell `ring` (k, 2): its middle, or along its edge moved inwards."""
    import shapely  # 0.2 s: only where a model with spheres is made

    edge = shapely.LinearRing(ring)
    middle = shapely.get_coordinates(shapely.centroid(shapely.Polygon(edge)))
    around = count if count in (2, 3) else count - 1
    shares = np.arange(around) / max(around, 1)
    on_edge = shapely.get_coordinates(shapely.line_interpolate_point(edge, shares, normalized=True))
    points = middle + (0.75 if around == 3 else 0.9) * (on_edge - middle)
    return points if around == count else np.vstack([middle, points])


def _numbers(array: NDArray[np.float64]) -> str:
    return " ".join(f"{v:.9g}" for v in array.ravel())
