"""A compiled free body with one sole, and its taxel reader."""

from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout
from plantar.sim.contact_models.sole_mjcf import Candidate, Contact, sole_mjcf
from plantar.sim.model.contact_truth import contact_wrench_in_frame, foot_contacts
from plantar.sim.sensing.skin import SoleSkin

Reader = Callable[[Any], NDArray[np.float64]]
"""Taxel forces (n,) in N from the MjData."""

MASS = 43.0  # kg: of the body
_ROUNDS = 8  # How often cells that would pull are left out of the fit to the wrench


class Sole(NamedTuple):
    """A compiled rig with one sole and its reader.

    `site`: id of the sole frame; `read`: taxel forces (n,) in N from the MjData.
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
    n = len(layout)
    site = model.site("left_sole").id

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
    n = len(layout)
    site = model.site("left_sole").id
    owner = np.zeros(model.ngeom, dtype=np.int64)
    for i in geoms:
        owner[i] = int(model.geom(i).name.split("_")[0].removeprefix("taxel"))

    def read(data: Any) -> NDArray[np.float64]:
        contacts = foot_contacts(model, data, geoms)
        normal = np.asarray(contacts.forces @ data.site_xmat[site].reshape(3, 3)[:, 2], dtype=np.float64)
        return np.asarray(np.bincount(owner[contacts.own_geoms], normal, minlength=n), dtype=np.float64)

    return read
