"""A box that floats without weight in place of a robot, in a world with partners that touch it."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any, cast

import mujoco

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.sim.body_skin.upper_body import upper_body_skin
from plantar.sim.model.world import World
from plantar.sim.partner.touch import Partner, Touch

HALF = (0.1, 0.2, 0.3)


def box_skin(body: BodyScale = REFERENCE_BODY) -> Any:
    """The box's skin, in its frame."""
    return upper_body_skin(_spec(body).compile(), 1, leg=body.leg, weight=body.weight)


def floating_box(partners: Sequence[Partner], body: BodyScale = REFERENCE_BODY, seed: int = 0) -> Touch:
    """A box of a robot's mass and proportions, with its partners in their places."""
    spec = _spec(body)
    for partner in partners:
        partner.add_to(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    world = cast("World", SimpleNamespace(model=model, data=data, torso=1, body=body, period=model.opt.timestep))
    touch = Touch(world, box_skin(body), partners, seed)
    touch.place()
    return touch


def _spec(body: BodyScale) -> Any:
    spec = mujoco.MjSpec()
    spec.option.timestep = 0.001
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    trunk = spec.worldbody.add_body(name="trunk", pos=[0.0, 0.0, 1.0], gravcomp=1.0)
    trunk.add_freejoint()
    size = [edge * body.leg / REFERENCE_BODY.leg for edge in HALF]
    trunk.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=size, mass=body.mass, contype=0, conaffinity=0)
    return spec
