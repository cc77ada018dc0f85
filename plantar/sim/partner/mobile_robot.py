"""A mobile robot before the walking one, with its hand at CoM height (K Fig. 9).

It rolls along the robot's initial heading, its arm is a spring, and it follows an impedance controller (K 39-41) with
limited force.
"""

import math
from typing import Any

import mujoco
import numpy as np

from plantar.common.settings.body_scale import BodyScale
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sensing.link_skin import BodySkin
from plantar.sim.model.world import World
from plantar.sim.partner.settings import PartnerSettings
from plantar.sim.partner.touch import Partner


class Impedance:
    """A mobile robot's reference motion along one axis.

    M x'' + D x' + K x = f_ex + f_in + K x_r (K 39). The rest x_r moves by the stride S once x is farther off (K 41,
    whose second case must read x < x_r - S).

    `position`: x in m; `velocity`: x' in m/s; `rest`: x_r in m.

    Example:
        >>> law = Impedance(PartnerSettings(role="leader"))
        >>> for _ in range(20000):
        ...     law.update(0.0, 0.001)
        >>> law.rest > 0.0
        True
    """

    def __init__(self, settings: PartnerSettings) -> None:
        self._law = settings
        self._built_in = settings.built_in_force if settings.role == "leader" else 0.0
        self.position = 0.0
        self.velocity = 0.0
        self.rest = 0.0

    def update(self, force: float, period: float) -> None:
        """Advance by `period` in s under external `force` f_ex in N, by semi-implicit Euler (K 40)."""
        law = self._law
        pull = law.virtual_stiffness * (self.position - self.rest)
        acceleration = (force + self._built_in - law.virtual_damping * self.velocity - pull) / law.virtual_mass
        self.velocity += acceleration * period
        self.position += self.velocity * period
        if self.position > self.rest + law.stride:
            self.rest += law.stride
        elif self.position < self.rest - law.stride:
            self.rest -= law.stride


_HAND = (0.02, 0.15, 0.1)  # leg: half edges of the hand: 18 x 12 cm for H1
_BASE = (0.35, 0.35, 0.2)  # leg: half edges of the base
_ARM = 0.45  # leg: from the base's front to the hand
# weight/leg, weight beat/leg: an arm of 5 kN/m and 150 N s/m before H1
_ARM_SPRING = 3.6
_ARM_DAMPING = 0.43
_ARM_MASS = 0.03  # of the robot: 2.6 kg before H1
_QUICK = 7.4  # 1/beat: how quickly the drive follows the reference, 30 rad/s for H1, critically damped
_TOUCHES = 0.00237  # weight: force on the hand that counts as contact, 2 N for H1


class MobileRobot(Partner):
    """The partner; `skin` is in the base frame, its hand at `height` in the world in m.

    `law`: impedance controller, its axis towards the robot; `moved`: True way to the robot in m; `force`: True hand
    force in N, positive towards the robot.
    """

    def __init__(self, settings: PartnerSettings, skin: BodySkin, body: BodyScale, height: float, seed: int) -> None:
        self.settings = settings
        self.law = Impedance(settings)
        self._body = body
        self._height = height
        self._front = float(skin.positions[skin.slices["front"]][:, 0].max())
        self._noise = np.random.default_rng([seed, 0x9A])
        self._start = math.nan
        self._place = -1
        self._axis = -1
        self.moved = 0.0
        self.force = 0.0
        self._forces: list[float] = []

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""
        leg = self._body.leg
        height = self._height
        body = spec.worldbody.add_body(name="partner")
        body.add_joint(name="partner_x", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
        hand, base = ([share * leg for share in shares] for shares in (_HAND, _BASE))
        middle = hand[0] + _ARM * leg + base[0]
        thick = 0.06 * leg
        top = (middle, 0.0, height)
        box = mujoco.mjtGeom.mjGEOM_BOX
        capsule = mujoco.mjtGeom.mjGEOM_CAPSULE
        arm = body.add_body(name="partner_arm")
        spring = _ARM_SPRING * self._body.weight / leg
        damping = _ARM_DAMPING * self._body.weight * self._body.beat / leg
        arm.add_joint(
            name="partner_arm", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0], stiffness=spring, damping=damping
        )
        mass = _ARM_MASS * self._body.mass
        shapes = [
            arm.add_geom(name="partner_hand", type=box, size=hand, pos=[hand[0], 0, height], mass=mass),
            body.add_geom(type=box, size=base, pos=[middle, 0, base[2] + 0.1 * leg], mass=self.settings.body_mass),
            arm.add_geom(type=capsule, size=[thick, 0, 0], fromto=[2 * hand[0], 0, height, *top], mass=0.0),
            body.add_geom(type=capsule, size=[2 * thick, 0, 0], fromto=[middle, 0, base[2], *top], mass=0.0),
        ]
        for geom, colour in zip(shapes, ([0.85, 0.6, 0.45, 1], *3 * ([0.45, 0.52, 0.6, 1],)), strict=True):
            geom.contype = 0
            geom.conaffinity = 0
            geom.group = 1
            geom.rgba = colour

    def bind(self, world: World) -> tuple[int, ...]:
        """Find it in the compiled world; returns its hand geom's id."""
        joint = world.model.joint("partner_x")
        self._place = int(joint.qposadr[0])
        self._axis = int(joint.dofadr[0])
        return (int(world.model.geom("partner_hand").id),)

    def place(self, world: World) -> None:
        """Put its hand before the robot standing in the `world`."""
        base = int(world.model.body_rootid[world.torso])
        self._start = float(world.data.xpos[base, 0]) + self._front + self.settings.apart
        world.data.qpos[self._place] = self._start
        world.data.qvel[self._axis] = 0.0

    def drive(self, world: World, skin: FoamSkins) -> None:
        """Measure, then follow the reference in the `world`, after `skin`."""
        data = world.data
        s = self.settings
        true = -float(skin.on_obstacles["partner_hand"][0])  # its axis points at the robot, against the world's x
        self.force = true
        self._forces.append(true)
        self.moved = self._start - float(data.qpos[self._place])
        if data.time >= s.starts:
            self.law.update(true + s.hand_noise * self._noise.standard_normal(), world.period)
        rate = _QUICK / self._body.beat
        off = self.law.position - self.moved
        speed = self.law.velocity + float(data.qvel[self._axis])
        wanted = s.body_mass * (rate * rate * off + 2.0 * rate * speed) - true
        data.qfrc_applied[self._axis] = -min(max(wanted, -s.drive_force), s.drive_force)

    @property
    def largest_force(self) -> float:
        """Largest true force in N between its hand and the robot."""
        return max(map(abs, self._forces), default=0.0)

    def summary(self) -> dict[str, Any]:
        """Role, its and its rest's way to the robot, largest force in N, share of time in touch."""
        forces = np.abs(np.array(self._forces or [0.0]))
        return {
            "role": self.settings.role,
            "moved_m": round(self.moved, 4),
            "rest_m": round(self.law.rest, 4),
            "largest_force_N": round(float(forces.max()), 1),
            "contact_share": round(float((forces > _TOUCHES * self._body.weight).mean()), 4),
        }
