"""A free body with one sole, compiled: which geoms touch the ground, and how taxel forces are read from them."""

from __future__ import annotations

from typing import Any, NamedTuple

import mujoco

from plantar.layouts.layout import SoleLayout
from plantar.sim.contact_models.candidate import Candidate, Contact
from plantar.sim.contact_models.sole_mjcf import sole_mjcf
from plantar.sim.contact_models.sole_readers import Reader, sole_reader

__all__ = ["Sole", "build_sole"]


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
    read: Reader


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
    attributes = contact.geom_attributes()
    assets, geoms, sensors = sole_mjcf(candidate, layout, attributes)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><compiler angle="radian"/>
        <option timestep="0.001" cone="{contact.cone}" impratio="{contact.friction_ratio:g}"/>
        <asset>{assets}</asset>
        <worldbody>{ground.format(contact=attributes)}
          <body name="left_foot"><freejoint/>
            <inertial pos="0 0 {com_height}" mass="{mass}" diaginertia="{mass / 20} {mass / 20} {mass / 40}"/>
            {geoms}<site name="left_sole"/>
          </body>
        </worldbody><sensor>{sensors}</sensor></mujoco>"""
    )
    ids = frozenset(
        i
        for i in range(model.ngeom)
        if model.body(int(model.geom_bodyid[i])).name == "left_foot" and model.geom_contype[i]
    )
    return Sole(model, model.site("left_sole").id, ids, sole_reader(candidate, model, layout, ids))
