"""Candidate contact models of a sole: which geoms touch the ground, and how taxel forces are read from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.layout import SoleLayout
from sim.contact_truth import contact_wrench_in_frame, foot_contacts
from sim.skin import SoleSkin

__all__ = ["CANDIDATES", "Candidate", "Contact", "Sole", "build_sole"]

SOLE_THICKNESS = 0.02  # m
_PRISM_DEPTH = 0.01  # m


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
    """Contact parameters of all geoms; the defaults are those recommended for a sole on stiff position servos."""

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


class Sole(NamedTuple):
    """A compiled rig with one sole and its reader.

    Attributes:
        model: The MjModel.
        site: Site id of the sole frame.
        geoms: Ids of the geoms that touch.
        read: Taxel forces (n,) in N from the MjData.
    """

    model: Any
    site: int
    geoms: frozenset[int]
    read: Callable[[Any], NDArray[np.float64]]


def build_sole(
    candidate: Candidate,
    layout: SoleLayout,
    ground: str,
    *,
    mass: float = 43.0,
    com_height: float = 0.05,
    contact: Contact | None = None,
) -> Sole:
    """Compile a free body with one sole over some ground.

    Args:
        candidate: Contact model of the sole.
        layout: The sole; its outline's bounding rectangle is the box.
        ground: MJCF of the ground's geoms with a placeholder {contact} for their contact parameters.
        mass: Mass of the body in kg.
        com_height: Height of its centre of mass above the sole in m.
        contact: Contact parameters.

    Returns:
        The compiled rig with its reader.

    Raises:
        InputError: If the candidate's kind or reading is unknown.
    """
    contact = contact or Contact()
    assets, geoms, sensor = _sole_mjcf(candidate, layout, contact)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><compiler angle="radian"/>
        <option timestep="0.001" cone="{contact.cone}" impratio="{contact.friction_ratio:g}"/>
        <asset>{assets}</asset>
        <worldbody>{ground.format(contact=contact.geom_attributes())}
          <body name="left_foot"><freejoint/>
            <inertial pos="0 0 {com_height}" mass="{mass}" diaginertia="{mass / 20} {mass / 20} {mass / 40}"/>
            {geoms}<site name="left_sole"/>
          </body>
        </worldbody><sensor>{sensor}</sensor></mujoco>"""
    )
    ids = frozenset(
        i
        for i in range(model.ngeom)
        if model.body(int(model.geom_bodyid[i])).name == "left_foot" and model.geom_contype[i]
    )
    return Sole(model, model.site("left_sole").id, ids, _reader(candidate, model, layout, ids))


def _sole_mjcf(candidate: Candidate, layout: SoleLayout, contact: Contact) -> tuple[str, str, str]:
    """Assets, geoms and sensors of a sole whose outer face is the plane z = 0 of its body."""
    attributes = contact.geom_attributes()
    if candidate.kind == "box":
        low, high = layout.outline.min(axis=0), layout.outline.max(axis=0)
        (cx, cy), (hx, hy), h = 0.5 * (low + high), 0.5 * (high - low), 0.5 * SOLE_THICKNESS
        box = f'<geom name="left_sole_box" type="box" size="{hx} {hy} {h}" pos="{cx} {cy} {h}" {attributes}/>'
        if candidate.reading == "patches":
            return "", box, ""
        if candidate.reading == "tactile":
            points = _numbers(np.column_stack([layout.positions[:, :2], np.zeros(len(layout))]))
            faces = " ".join(str(int(v)) for v in _triangles(layout.positions[:, :2]).ravel())
            mesh = f'<mesh name="taxels" inertia="shell" vertex="{points}" face="{faces}"/>'
            # The sensor takes the points in the frame of its geom: a geom of the same mesh puts them where they are.
            skin = '<geom name="left_taxels" type="mesh" mesh="taxels" contype="0" conaffinity="0" mass="0"/>'
            return mesh, box + skin, '<tactile name="left_taxels" geom="left_taxels" mesh="taxels"/>'
    elif candidate.kind == "spheres" and candidate.count > 0:
        radius = 0.004
        parts = [
            f'<geom name="taxel{i}_{j}" type="sphere" size="{radius}" pos="{x} {y} {radius}" {attributes}/>'
            for i in range(len(layout))
            for j, (x, y) in enumerate(_support_points(layout.cell_polygon(i), candidate.count))
        ]
        return "", "".join(parts), ""
    elif candidate.kind == "prisms":
        meshes, parts = [], []
        for i in range(len(layout)):
            if candidate.count == 0:
                ring = layout.cell_polygon(i)
                corners = np.vstack([np.column_stack([ring, np.full(len(ring), z)]) for z in (0.0, _PRISM_DEPTH)])
                meshes.append(f'<mesh name="taxel{i}" vertex="{_numbers(corners)}"/>')
                parts.append(f'<geom name="taxel{i}_0" type="mesh" mesh="taxel{i}" {attributes}/>')
            else:
                half, (x, y) = 0.5 * float(np.sqrt(layout.areas[i])), layout.positions[i, :2]
                parts.append(
                    f'<geom name="taxel{i}_0" type="box" size="{half} {half} {0.5 * _PRISM_DEPTH}" '
                    f'pos="{x} {y} {0.5 * _PRISM_DEPTH}" {attributes}/>'
                )
        return "".join(meshes), "".join(parts), ""
    raise InputError(f"contact model {candidate.name!r} has an unknown kind or reading; allowed: see CANDIDATES")


def _reader(
    candidate: Candidate, model: Any, layout: SoleLayout, ids: frozenset[int]
) -> Callable[[Any], NDArray[np.float64]]:
    if candidate.reading == "patches":
        skin = SoleSkin(model, layout, "left_sole", ["left_sole_box"])
        return lambda data: skin.taxel_forces(data)
    n = len(layout)
    site = model.site("left_sole").id
    if candidate.reading == "tactile":
        u = np.column_stack([np.ones(n), layout.positions[:, :2]])

        def from_tactile(data: Any) -> NDArray[np.float64]:
            depth = np.abs(data.sensordata[:n])
            total = depth.sum()
            if not total > 0.0:
                return np.zeros(n)
            wrench = contact_wrench_in_frame(
                foot_contacts(model, data, ids), data.site_xpos[site], data.site_xmat[site]
            )
            if candidate.fit == "force":
                return np.asarray(depth * (max(float(wrench[2]), 0.0) / total))
            # depth_i max(0, a + b x_i + c y_i) with the wrench's three normal parts, cells that would pull left out.
            load = np.array([wrench[2], -wrench[4], wrench[3]])
            active = np.ones(n, dtype=bool)
            for _ in range(8):
                weighted = (depth * active)[:, None] * u
                force = weighted @ np.linalg.lstsq(weighted.T @ u, load, rcond=1e-10)[0]
                if force.min() >= 0.0:
                    break
                active &= force > 0.0
            return np.asarray(np.maximum(force, 0.0))

        return from_tactile

    owner = np.zeros(model.ngeom, dtype=np.int64)
    for i in ids:
        owner[i] = int(model.geom(i).name.split("_")[0].removeprefix("taxel"))

    def from_contacts(data: Any) -> NDArray[np.float64]:
        contacts = foot_contacts(model, data, ids)
        normal = np.asarray(contacts.forces @ data.site_xmat[site].reshape(3, 3)[:, 2], dtype=np.float64)
        return np.asarray(np.bincount(owner[contacts.own_geoms], normal, minlength=n), dtype=np.float64)

    return from_contacts


def _support_points(ring: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """Points (count, 2) that support a cell: its middle, or points evenly along its edge moved inwards."""
    edge = np.roll(ring, -1, axis=0) - ring
    length = np.hypot(edge[:, 0], edge[:, 1])
    cross = ring[:, 0] * np.roll(ring[:, 1], -1) - np.roll(ring[:, 0], -1) * ring[:, 1]
    middle = np.asarray((ring + np.roll(ring, -1, axis=0)).T @ cross / (3.0 * cross.sum()), dtype=np.float64)
    around = count if count in (2, 3) else count - 1
    if around <= 0:
        return middle[None]
    along = np.concatenate([[0.0], np.cumsum(length)])
    wanted = along[-1] * np.arange(around) / around
    closed = np.vstack([ring, ring[:1]])
    on_edge = np.column_stack([np.interp(wanted, along, closed[:, k]) for k in range(2)])
    points = middle + (0.75 if around == 3 else 0.9) * (on_edge - middle)
    return points if around == count else np.vstack([middle, points])


def _triangles(points: NDArray[np.float64]) -> NDArray[np.int64]:
    from scipy.spatial import Delaunay  # only for the tactile sensor's mesh

    return np.asarray(Delaunay(points).simplices, dtype=np.int64)


def _numbers(array: NDArray[np.float64]) -> str:
    return " ".join(f"{v:.9g}" for v in array.ravel())
