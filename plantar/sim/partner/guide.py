"""A hand that leads a robot by its forearm, with two fingers.

It has mass but no weight, follows its path by a spring of limited force, else the forearm, and acts through skin alone
(`plantar.sim.body_skin`).
"""

import math
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.mechanics.easing import minimum_jerk
from plantar.mujoco.foam_skins import FoamSkins
from plantar.sim.model.world import World
from plantar.sim.partner.hand import body_point
from plantar.sim.partner.settings import GuideSettings
from plantar.sim.partner.touch import Partner

_MASS = 0.02  # of the robot: 1.7 kg next to H1, as a hand and forearm
# leg: radius of a finger and half its length, 20 and 45 mm
_FINGER = 1 / 30
_LONG = 0.075
_PLAY = 0.02  # leg: on each side of the arm, 12 mm: an arm that yields turns, and is thicker along the way then
_QUICK = 7.4  # 1/beat: how quickly it goes along with the forearm, 30 rad/s for H1, critically damped
_COLOUR = (0.85, 0.6, 0.45, 1.0)


class Grip(NamedTuple):
    """Held `link`, middle of the arm `point` (3,) in its frame, and `radius`, in m."""

    link: str
    point: NDArray[np.float64]
    radius: float


class Guide(Partner):
    """The hand; `seed` chooses start and open direction.

    `grip`: where it takes the arm; `sign`: 1 forward, -1 backward; `starts`: when it leads in s; `moved`: True way in
    m; `reference` the wanted one; `force`: True force in N along its way.
    """

    def __init__(self, settings: GuideSettings, grip: Grip, body: BodyScale, seed: int) -> None:
        self.settings = settings
        self.grip = grip
        self._body = body
        rng = np.random.default_rng([seed, 0x6D])
        drawn = float(rng.choice([-1.0, 1.0]))
        self.sign = {"forward": 1.0, "backward": -1.0}.get(settings.toward, drawn)
        self.starts = settings.sets_out + float(rng.uniform(0.0, settings.within))
        self._mass = _MASS * body.mass
        self._apart = grip.radius + (_PLAY + _FINGER) * body.leg
        self._places = np.arange(3)
        self._axes = self._places
        self._link = -1
        self._root = -1
        self._start = math.nan
        self.moved = 0.0
        self.reference = 0.0
        self.force = 0.0
        self._forces: list[float] = []

    @property
    def lasts(self) -> float:
        """Duration in s."""
        return self.settings.way / self.settings.hand_speed

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""
        leg = self._body.leg
        apart = self._apart
        body = spec.worldbody.add_body(name="guide", gravcomp=1.0)
        for name, axis in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1])):
            body.add_joint(name=f"guide_{name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
        capsule = mujoco.mjtGeom.mjGEOM_CAPSULE
        radius = _FINGER * leg
        half = _LONG * leg
        across = [-apart, 0.0, half + radius, apart, 0.0, half + radius]
        shapes = [
            body.add_geom(name=name, type=capsule, size=[radius, half, 0.0], pos=[x, 0.0, 0.0], mass=0.5 * self._mass)
            for name, x in (("guide_behind", -apart), ("guide_before", apart))
        ]
        shapes.append(body.add_geom(type=capsule, size=[radius, 0.0, 0.0], fromto=across, mass=0.0))
        for geom in shapes:
            geom.contype = 0
            geom.conaffinity = 0
            geom.group = 1
            geom.rgba = _COLOUR

    def bind(self, world: World) -> tuple[int, ...]:
        """Find it in the compiled world."""
        first = world.model.joint("guide_x")
        self._places = int(first.qposadr[0]) + np.arange(3)
        self._axes = int(first.dofadr[0]) + np.arange(3)
        self._link = int(world.model.body(self.grip.link).id)
        self._root = int(world.model.body_rootid[self._link])
        return tuple(int(world.model.geom(name).id) for name in ("guide_behind", "guide_before"))

    def place(self, world: World) -> None:
        """Put fingers about the forearm of a standing robot in a `world`."""
        world.data.qpos[self._places] = self.held(world)[0]
        world.data.qvel[self._axes] = 0.0

    def position(self, world: World) -> NDArray[np.float64]:
        """Middle between its fingers (3,) in the world in m."""
        return np.array(world.data.qpos[self._places])

    def held(self, world: World) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Held arm's true middle (3,) in m and velocity (3,) in m/s, world frame."""
        return body_point(world.data, self._link, self._root, self.grip.point)

    def drive(self, world: World, skin: FoamSkins) -> None:
        """Set its forces in the `world` for a physics step, after `skin`."""
        data = world.data
        s = self.settings
        time = float(world.data.time)
        self.force = -self.sign * sum(float(skin.on_obstacles[f"guide_{side}"][0]) for side in ("behind", "before"))
        self._forces.append(self.force)
        place = data.qpos[self._places]
        speed = data.qvel[self._axes]
        arm, motion = self.held(world)
        rate = _QUICK / self._body.beat
        force = self._mass * (rate * rate * (arm - place) + 2.0 * rate * (motion - speed))
        if time >= self.starts:
            if math.isnan(self._start):
                self._start = float(place[0])
            share, pace = minimum_jerk((time - self.starts) / self.lasts)
            self.reference = s.way * share
            self.moved = self.sign * (float(place[0]) - self._start)
            off = self.reference - self.moved
            lag = s.hand_speed * pace - self.sign * float(speed[0])
            wanted = s.hand_spring * off + 2.0 * math.sqrt(s.hand_spring * self._mass) * lag
            force[0] = self.sign * min(max(wanted, -s.hand_force), s.hand_force)
        data.qfrc_applied[self._axes] = force

    def summary(self) -> dict[str, Any]:
        """Direction, begin in s, wanted and true way in m, largest force in N."""
        return {
            "direction": "forward" if self.sign > 0.0 else "backward",
            "set_out_s": round(self.starts, 3),
            "way_m": round(self.settings.way, 4),
            "moved_m": round(self.moved, 4),
            "largest_force_N": round(float(np.abs(np.array(self._forces or [0.0])).max()), 1),
        }
