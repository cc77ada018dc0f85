"""Contact models of a sole, as MJCF and as a compiled free body: its outer face is z = 0."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.sim.model.contact_truth import contact_wrench_in_frame, foot_contacts
from plantar.sim.sensing.skin import SoleSkin


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


Reader = Callable[[Any], NDArray[np.float64]]
"""Taxel forces (n,) in N from the MjData."""

MASS = 43.0  # kg: of the body
_ROUNDS = 8  # How often cells that would pull are left out of the fit to the wrench


class Sole(NamedTuple):
    """A compiled rig with one sole and its reader.

    Attributes:
        site: Id of the sole frame.
        geoms: Ids that touch.
        read: Taxel forces (n,) in N from the MjData.
    """

    model: Any
    site: int
    geoms: frozenset[int]
    read: Reader


def build_sole(candidate: Candidate, layout: SoleLayout, ground: str, contact: Contact | None = None) -> Sole:
    """Returns the compiled rig of a free body with one sole over some ground.

    Of a contact model `candidate`, a `layout`, whose bounding rectangle is the box, MJCF of `ground` geoms with
    placeholder {contact}, and `contact` parameters. An InputError if kind or reading is unknown.
    """
    contact = contact or Contact()
    attributes = contact.geom_attributes()
    assets, geoms, sensors = sole_mjcf(candidate, layout, attributes)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><compiler angle="radian"/>
        <option timestep="0.001" cone="{contact.cone}" impratio="{contact.friction_ratio:g}"/>
        <asset>{assets}</asset>
        <worldbody>{ground.format(contact=attributes)}
          <body name="left_foot"><freejoint/>
            <inertial pos="0 0 0.05" mass="{MASS}" diaginertia="{MASS / 20} {MASS / 20} {MASS / 40}"/>
            {geoms}<site name="left_sole"/>
          </body>
        </worldbody><sensor>{sensors}</sensor></mujoco>"""
    )
    ids = frozenset(
        i
        for i in range(model.ngeom)
        if model.body(int(model.geom_bodyid[i])).name == "left_foot" and model.geom_contype[i]
    )
    return Sole(model, model.site("left_sole").id, ids, _reader(candidate, model, layout, ids))


def _reader(candidate: Candidate, model: Any, layout: SoleLayout, geoms: frozenset[int]) -> Reader:
    if candidate.reading == "patches":
        return SoleSkin(model, layout, "left_sole", ["left_sole_box"]).taxel_forces
    return (_tactile if candidate.reading == "tactile" else _by_contact)(candidate, model, layout, geoms)


def _tactile(candidate: Candidate, model: Any, layout: SoleLayout, geoms: frozenset[int]) -> Reader:
    n, site = len(layout), model.site("left_sole").id

    def read(data: Any) -> NDArray[np.float64]:
        depth = np.abs(data.sensordata[:n])
        total = depth.sum()
        if not total > 0.0:
            return np.zeros(n)
        contacts = foot_contacts(model, data, geoms)
        wrench = contact_wrench_in_frame(contacts, data.site_xpos[site], data.site_xmat[site])
        if candidate.fit == "force":
            return np.asarray(depth * (max(float(wrench[2]), 0.0) / total))
        return _fitted(depth, layout, wrench)

    return read


def _fitted(depth: NDArray[np.float64], layout: SoleLayout, wrench: NDArray[np.float64]) -> NDArray[np.float64]:
    """depth_i max(0, a + b x_i + c y_i) by the wrench's normal parts."""
    u = np.column_stack([np.ones(len(layout)), layout.positions[:, :2]])
    load = np.array([wrench[2], -wrench[4], wrench[3]])
    active = np.ones(len(layout), dtype=bool)
    for _ in range(_ROUNDS):
        weighted = (depth * active)[:, None] * u
        force = weighted @ np.linalg.lstsq(weighted.T @ u, load, rcond=1e-10)[0]
        if force.min() >= 0.0:
            break
        active &= force > 0.0
    return np.asarray(np.maximum(force, 0.0))


def _by_contact(candidate: Candidate, model: Any, layout: SoleLayout, geoms: frozenset[int]) -> Reader:
    n, site = len(layout), model.site("left_sole").id
    owner = np.zeros(model.ngeom, dtype=np.int64)
    for i in geoms:
        owner[i] = int(model.geom(i).name.split("_")[0].removeprefix("taxel"))

    def read(data: Any) -> NDArray[np.float64]:
        contacts = foot_contacts(model, data, geoms)
        normal = np.asarray(contacts.forces @ data.site_xmat[site].reshape(3, 3)[:, 2], dtype=np.float64)
        return np.asarray(np.bincount(owner[contacts.own_geoms], normal, minlength=n), dtype=np.float64)

    return read
