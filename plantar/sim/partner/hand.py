"""A flat hand that follows and presses a robot's upper body.

It has mass but no weight, slides along the world's axes and turns about the vertical, and acts through skin alone.
"""

from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.sim.body_skin.upper_body import FACES


def body_point(
    data: Any, body: int, root: int, local: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns position (3,) in m and velocity (3,) in m/s in the world of a point `local` (3,) in m of a `body`, by
    ids.

    MuJoCo's `data` has velocities of the CoM of the tree's `root`.
    """
    place = data.xpos[body] + data.xmat[body].reshape(3, 3) @ local
    # The cross product in full: np.cross takes ten times as long, and this runs once a physics step.
    wx, wy, wz = data.cvel[body, :3].tolist()
    x, y, z = (place - data.subtree_com[root]).tolist()
    return place, data.cvel[body, 3:] + np.array([wy * z - wz * y, wz * x - wx * z, wx * y - wy * x])


_MASS = 0.02  # of the robot: 1.7 kg for H1, as a hand and forearm
# leg: half edges of the palm, 9 x 9 cm and 24 mm for H1
_WIDE = 0.075
_THICK = 0.02
_QUICK = 7.4  # 1/beat: natural frequency of how it follows a point, 30 rad/s for H1, critically damped
_ARM = 0.35  # leg: length of the drawn forearm


class HandTarget(NamedTuple):
    """Where a hand should be.

    `position` of its palm (3,) in the world in m; `velocity` of that point (3,) in m/s; `yaw`: robot heading in rad;
    `inward`: pressing direction (3,) in the world; `force` in N along that; None to hold position.
    """

    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    yaw: float
    inward: NDArray[np.float64]
    force: float | None = None


class Hand:
    """A hand for one face of the upper body.

    `face`: one of `plantar.sim.body_skin.upper_body.FACES`; `half`: half its palm's edge in m.
    """

    def __init__(self, face: str, body: BodyScale) -> None:
        self.face = face
        self.name = f"hand_{face}"
        self.half = _WIDE * body.leg
        self._thick = _THICK * body.leg
        self._arm = _ARM * body.leg
        self._mass = _MASS * body.mass
        self._stiffness = self._mass * (_QUICK / body.beat) ** 2
        self._damping = 2.0 * self._mass * _QUICK / body.beat
        self._axes = np.arange(4)
        self._places = np.arange(4)
        self._turning = 0.0
        self.geom = -1

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""
        body = spec.worldbody.add_body(name=self.name, gravcomp=1.0)
        for name, axis in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1])):
            body.add_joint(name=f"{self.name}_{name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
        body.add_joint(name=f"{self.name}_yaw", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1])
        forward, left = np.abs(FACES[self.face]).tolist()
        size = [
            self._thick if forward else self.half,
            self._thick if left else self.half,
            self.half,
        ]
        palm = body.add_geom(name=self.name, type=mujoco.mjtGeom.mjGEOM_BOX, size=size, mass=self._mass)
        x, y = FACES[self.face]
        near = self._thick + 0.25 * self.half
        far = self._arm
        arm = body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            size=[0.4 * self.half, 0.0, 0.0],
            fromto=[near * x, near * y, 0.0, far * x, far * y, -0.3 * far],
            mass=0.0,
        )
        for geom in (palm, arm):
            geom.contype = 0
            geom.conaffinity = 0
            geom.group = 1
            geom.rgba = [0.85, 0.6, 0.45, 1.0]

    def bind(self, model: Any) -> None:
        """Find it in the compiled world."""
        first = model.joint(f"{self.name}_x")
        self._places = int(first.qposadr[0]) + np.arange(4)
        self._axes = int(first.dofadr[0]) + np.arange(4)
        self.geom = int(model.geom(self.name).id)
        self._turning = float(model.body_inertia[model.body(self.name).id].max())

    def place(self, data: Any, target: HandTarget) -> None:
        """Put it at a `target` in `data`, at rest."""
        data.qpos[self._places[:3]] = self._middle(target)
        data.qpos[self._places[3]] = target.yaw
        data.qvel[self._axes] = 0.0

    def drive(self, data: Any, target: HandTarget) -> None:
        """Set its forces in `data` towards a `target`, once a physics step."""
        place = data.qpos[self._places]
        motion = data.qvel[self._axes]
        force = self._stiffness * (self._middle(target) - place[:3]) + self._damping * (target.velocity - motion[:3])
        if target.force is not None:
            force += (target.force - float(force @ target.inward)) * target.inward
        rate = self._stiffness / self._mass
        turn = rate * (target.yaw - place[3]) - self._damping / self._mass * motion[3]
        data.qfrc_applied[self._axes[:3]] = force
        data.qfrc_applied[self._axes[3]] = self._turning * turn

    def _middle(self, target: HandTarget) -> NDArray[np.float64]:
        return target.position - self._thick * target.inward
