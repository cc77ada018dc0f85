"""How arm and feet of a led robot followed the hand."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.sim.judging.unmet import unmet
from plantar.sim.model.world import World

YIELDED = 0.15
"""Share of the way by which the arm has to have given way, as the place where it is held moves against the trunk: the
hand goes for some steps before the feet can follow."""

FOLLOWED = 2 / 3
"""Share of the way by which the feet have to have followed at the end: the rest is what the arm gives way by while the
force on it is too small to move a step."""

ASTRAY = 0.5
"""Share of the way by which the feet may have gone to a side at the end. Skin pushes along its normal: on a forearm
that yields, and so turns by up to 25 degrees about the vertical, as much as tan(25 deg) of the force goes aside."""


class GuideTruth:
    """Follows arm and feet of a robot that is led.

    `world`: the world; `point`: held point (3,) in its frame in m; `posture`: angles (k,) in rad at rest; `way`: the
    hand's along the world's x axis in m; `starts`: when it moves in s.
    """

    def __init__(
        self,
        world: World,
        link: str,
        point: NDArray[np.float64],
        joints: Sequence[str],
        posture: NDArray[np.float64],
        way: float,
        starts: float,
    ) -> None:
        self._world = world
        self._point = point
        self._posture = posture
        self._link = int(world.model.body(link).id)
        self._base = int(world.model.body_rootid[self._link])
        self._places = np.array([int(world.model.joint(name).qposadr[0]) for name in joints])
        self._way = abs(way)
        self._sign = math.copysign(1.0, way)
        self._starts = starts
        self._from: tuple[float, float, float] | None = None
        self._sampled = False
        self.yielded = 0.0
        self.followed = 0.0
        self.astray = 0.0
        self.turned = 0.0

    def update(self, time: float) -> None:
        """Measure arm and feet at `time` in s, after its physics step."""
        data = self._world.data
        held = data.xpos[self._link] + data.xmat[self._link].reshape(3, 3) @ self._point
        trunk = data.xmat[self._base].reshape(3, 3)
        # In the trunk's frame: a trunk that turns is no arm that yields.
        ahead = self._sign * float(trunk[:, 0] @ (held - data.xpos[self._base]))
        x, y, _ = np.mean([data.site_xpos[self._world.sole_sites[side]] for side in SIDES], axis=0).tolist()
        if self._from is None or time < self._starts:
            self._from = (ahead, x, y)
            return
        self._sampled = True
        self.yielded = max(self.yielded, ahead - self._from[0])
        self.followed = self._sign * (x - self._from[1])
        self.astray = abs(y - self._from[2])
        self.turned = max(self.turned, float(np.abs(data.qpos[self._places] - self._posture).max()))

    def reasons(self) -> list[dict[str, Any]]:
        """Failed criteria, as `verdict.reasons`."""
        gone = self._way
        asked = f"m; a hand that goes {self._way:.3f} m asks for"
        least, way, aside = (round(share * gone, 4) for share in (YIELDED, FOLLOWED, ASTRAY))
        yielded = f"the arm gave way by {self.yielded:.3f}"
        followed = f"the feet followed {self.followed:.3f}"
        astray = f"the feet went {self.astray:.3f} m to a side; allowed: {aside:.3f} m on a way of {gone:.3f} m"
        return unmet(
            (self.yielded >= YIELDED * gone, "yielded", self.yielded, least, f"{yielded} {asked} {least:.3f} m"),
            (self.followed >= FOLLOWED * gone, "followed", self.followed, way, f"{followed} {asked} {way:.3f} m"),
            (self.astray <= ASTRAY * gone, "astray", self.astray, aside, astray),
        )

    def summary(self) -> dict[str, Any]:
        """Arm's largest yield, feet's final way and across in m, and an arm joint's largest turn in degrees."""
        if not self._sampled:
            return dict.fromkeys(("arm_yielded_m", "feet_followed_m", "feet_astray_m", "arm_turned_deg"))
        return {
            "arm_yielded_m": round(self.yielded, 4),
            "feet_followed_m": round(self.followed, 4),
            "feet_astray_m": round(self.astray, 4),
            "arm_turned_deg": round(math.degrees(self.turned), 2),
        }
