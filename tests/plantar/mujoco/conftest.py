"""Models of many kinds, and MuJoCo's own sum of a sole's contacts."""

import os
from pathlib import Path

import mujoco
import numpy as np
import pytest

ROBOTS = Path(os.environ.get("PLANTAR_REAL_DATA", "none")) / "robots"
FREE = '<body name="foot" pos="0 0 {z}" euler="{euler}"><freejoint/>{geoms}</body>'
PLANE = '<geom type="plane" size="3 3 1"/>'
BOX = '<geom type="box" size=".12 .05 .02" mass="8" condim="{condim}" friction="1 .02 .01"/>'
BOULDER = '<geom type="sphere" size=".02" pos=".05 .02 .15" mass="3" contype="0" conaffinity="0"/>'


def world(ground: str, geoms: str, z: float = 0.02, euler: str = "0 0 0", options: str = "", assets: str = "") -> str:
    """A free body called foot on some ground."""
    foot = FREE.format(z=z, euler=euler, geoms=geoms)
    return f"<mujoco><option {options}/><asset>{assets}</asset><worldbody>{ground}{foot}</worldbody></mujoco>"


def box(condim: int = 3, options: str = "", ground: str = PLANE, z: float = 0.02, euler: str = "0 0 0") -> str:
    """A box with an eccentric load."""
    return world(ground, BOX.format(condim=condim) + BOULDER, z, euler, options)


SPHERES = "".join(f'<geom type="sphere" size=".006" pos="{x} {y} -.02" mass="2"/>' for x, y in
                  ((0.12, 0.03), (0.12, -0.03), (-0.05, 0.025), (-0.05, -0.025), (0.04, 0.0)))  # fmt: skip
CAPSULES = "".join(f'<geom type="capsule" size=".01" fromto="-.06 {y} 0 .14 {y} 0" mass="3"/>' for y in (-0.03, 0.03))
WEDGE = '<mesh name="wedge" vertex="-.1 -.05 0 .1 -.05 0 .12 .04 0 -.1 .05 0 -.08 0 .06 .05 0 .05"/>'
SLABS = (
    '<geom type="box" size=".1 .3 .05" pos="-.1 0 -.05"/><geom type="box" size=".1 .3 .05" pos=".1 0 -.0502"/>'
    '<geom type="box" size=".1 .3 .05" pos=".3 0 -.05"/>'
)
HILLS = '<hfield name="hills" nrow="9" ncol="9" size=".4 .4 .03 .01" elevation="{}"/>'.format(
    " ".join(f"{0.5 + 0.4 * np.sin(2 * i) * np.cos(1.7 * j):.3f}" for i in range(9) for j in range(9))
)
MOVING = (
    '<body name="slab" pos="0 0 -.1"><joint type="slide" axis="1 0 0" damping="20"/><geom type="box" size=".5 .5 .1" '
    'mass="20" friction="1"/></body>'
)
SOFT = (
    '<flexcomp name="soft" type="grid" count="4 3 2" spacing=".1 .1 .05" pos="0 0 .045" dim="3" mass="5">'
    '<edge equality="true"/><contact selfcollide="none"/></flexcomp><geom type="plane" size="3 3 1"/>'
)
TWO = (
    '<mujoco><worldbody><body pos="0 0 .05"><freejoint/><geom type="box" size=".5 .5 .05" mass="30"/></body>'
    f'{PLANE}<body name="foot" pos="0 .2 .121"><freejoint/><geom type="box" size=".1 .05 .02" mass="8"/></body>'
    '<body name="other" pos="0 -.2 .121"><freejoint/><geom type="box" size=".1 .05 .02" mass="8"/></body>'
    "</worldbody></mujoco>"
)
ARM = (
    '<mujoco><worldbody><geom type="box" size=".2 .2 .1" pos=".4 0 .1"/><body pos="0 0 .45" euler="0 35 0">'
    '<joint name="shoulder" axis="0 1 0" damping="2"/><geom type="capsule" size=".03" fromto="0 0 0 .4 0 0" mass="3"/>'
    '<body name="foot" pos=".4 0 0"><geom type="sphere" size=".035" mass="1"/></body></body></worldbody></mujoco>'
)
LOAD = '<body pos=".05 .03 .12"><freejoint/><geom type="box" size=".1 .05 .02" mass="5"/></body>'
STACK = world(PLANE + LOAD, '<geom type="box" size=".2 .15 .05" mass="5"/>', 0.05)

KINDS = {
    "box": box(),
    "box, elliptic cone, torsion": box(4, 'cone="elliptic"'),
    "box, frictionless, implicit": box(1, 'integrator="implicitfast"'),
    "box, rolling friction, RK4": box(6, 'integrator="RK4"'),
    "spheres": world(PLANE, SPHERES + BOULDER, 0.026),
    "capsules": world(PLANE, CAPSULES + BOULDER, 0.01),
    "mesh": world(PLANE, '<geom type="mesh" mesh="wedge" mass="6"/>', 0.001, assets=WEDGE),
    "cylinder": world(PLANE, '<geom type="cylinder" size=".06 .03" mass="4"/>' + BOULDER, 0.03),
    "ellipsoid": world(PLANE, '<geom type="ellipsoid" size=".12 .08 .05" mass="4"/>', 0.05),
    "several slabs": box(ground=SLABS),
    "height field": world('<geom type="hfield" hfield="hills"/>', BOX.format(condim=3), 0.05, assets=HILLS),
    "moving ground": box(ground=MOVING),
    "soft ground": box(ground=SOFT, z=0.097),
    "two soles on a slab": TWO,
    "arm that presses a table": ARM,
}
"""One model a kind, each with a body "foot"."""


@pytest.fixture
def make_box():
    return box


@pytest.fixture
def contact_wrench():
    """MuJoCo's wrench of a skin's contacts in the sole frame, from `mj_contactForce` and the body's pose."""

    def summed(feel, data):
        model = feel.model
        turn = data.xmat[feel.body].reshape(3, 3) @ feel.rotation_to_body
        origin = data.xpos[feel.body] + data.xmat[feel.body].reshape(3, 3) @ feel.position_in_body
        out, local = np.zeros(6), np.zeros(6)
        for i in range(data.ncon):
            own = [int(g) in feel.geom_ids for g in data.contact.geom[i]]
            if own[0] == own[1]:
                continue
            mujoco.mj_contactForce(model, data, i, local)
            axes = data.contact.frame[i].reshape(3, 3).T * (1.0 if own[1] else -1.0)
            force, torque = axes @ local[:3], axes @ local[3:]
            out[:3] += force
            out[3:] += torque + np.cross(data.contact.pos[i] - origin, force)
        return np.concatenate([out[:3] @ turn, out[3:] @ turn])

    return summed
