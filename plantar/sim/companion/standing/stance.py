"""Feet on the ground: support, and the base's place."""

from collections.abc import Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.mechanics.rotation import rotation_error
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.wholebody.tasks.support import Standing, Support

_LEVEL = np.eye(3)
# Name of the site that is a foot's sole frame in a machine's MJCF.
SOLE_SITE = "{side}_sole"


def add_floor(spec: Any, carries: bool = True) -> None:
    """Add a ground z = 0 to a `spec`, which skin does not measure, and which `carries` soles or is only seen."""
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[5.0, 5.0, 0.1],
        material="ground",
        contype=2 * carries,
        conaffinity=1 * carries,
        friction=[0.8, 0.005, 0.0001],
    )


class Stance:
    """Feet at known places on the ground.

    `model`: MjModel of machine alone; `sides`: standing feet: "left", "right" or both. Attributes `feet`: middle (3,)
    of each standing sole by its link, link frame, in m; `places`: that point (3,) in the world in m.
    """

    def __init__(self, model: Any, sides: Sequence[str]) -> None:
        self.feet: dict[str, NDArray[np.float64]] = {}
        self.places: dict[str, NDArray[np.float64]] = {}
        self.model = model
        for side in sides:
            link, point = sole_point(model, side)
            self.feet[link] = point

    def place(self, robot: MujocoDynamics) -> None:
        """Fix the soles to the ground below their present places."""
        for link, point in self.feet.items():
            self.places[link] = robot.place(link, point) * [1.0, 1.0, 0.0]

    def support(self) -> Support:
        """The task that keeps these feet where they are."""
        return Support({link: Standing(link, point) for link, point in self.feet.items()})

    def locate(self, robot: MujocoDynamics) -> None:
        """Set a measured `robot`'s base position and velocity so that the feet rest."""
        qpos = robot.data.qpos.copy()
        qvel = robot.data.qvel.copy()
        off = np.zeros(3)
        slip = np.zeros(3)
        for link, point in self.feet.items():
            origin, rotation = robot.pose(link)
            off += self.places[link] - origin - rotation @ point
            slip += robot.jacobian(link, point)[:3] @ robot.velocity
        qpos[:3] += off / len(self.feet)
        qvel[:3] -= slip / len(self.feet)
        robot.update(qpos, qvel, robot.time)

    def solve(
        self,
        robot: MujocoDynamics,
        com: NDArray[np.float64],
        base: tuple[str, NDArray[np.float64]],
        lifted: Mapping[str, NDArray[np.float64]],
    ) -> NDArray[np.float64]:
        """Returns positions (nq,) with level feet, the centre of mass `com` (3,) in m, the `base` link turned to a
        rotation (3, 3) to the world, and further level links `lifted` with their origin (3,) in m. The `robot`, in a
        near posture, is updated.
        """
        qpos = robot.data.qpos.copy()
        rest = robot.data.qpos.copy()
        n = self.model.nv
        level = [(link, point, self.places[link]) for link, point in self.feet.items()]
        level += [(link, np.zeros(3), place) for link, place in lifted.items()]
        for _ in range(60):
            rows = []
            errors = []
            for link, point, place in level:
                origin, rotation = robot.pose(link)
                rows.append(robot.jacobian(link, point))
                errors += [place - origin - rotation @ point, rotation_error(_LEVEL, rotation)]
            rows.append(robot.jacobian(base[0])[3:])
            errors.append(rotation_error(base[1], robot.pose(base[0])[1]))
            position, jacobian, _drift = robot.com()
            rows.append(jacobian)
            errors.append(com - position)
            stacked = np.vstack(rows)
            missing = np.concatenate(errors)
            inverse = np.linalg.pinv(stacked, rcond=1e-6)
            back = np.zeros(n)
            mujoco.mj_differentiatePos(self.model, back, 1.0, qpos, rest)
            step = inverse @ missing + 0.2 * (back - inverse @ (stacked @ back))
            step *= min(1.0, 0.2 / float(np.abs(step).max(initial=1e-9)))
            mujoco.mj_integratePos(self.model, qpos, step, 1.0)
            robot.update(qpos, np.zeros(n), 0.0)
        return np.asarray(qpos)


def sole_point(model: Any, side: str) -> tuple[str, NDArray[np.float64]]:
    """Returns the foot link of a `side` of `model`, and its sole's middle (3,), link frame, in m."""
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, SOLE_SITE.format(side=side))
    geom = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, f"{side}_sole_box")
    if site < 0 or geom < 0:
        raise RobotError(f"the machine has no {side} sole; it needs a site '{side}_sole' and a geom '{side}_sole_box'")
    point = model.geom_pos[geom].copy()
    point[2] = model.site_pos[site, 2]
    return model.body(int(model.site_bodyid[site])).name, point
