"""Touches on the arm guide the hand (A 11-12), which stays where the arm is bent."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.errors import InputError
from plantar.mechanics.easing import minimum_jerk
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.skin_interaction import DirectInteraction
from plantar.wholebody.tasks.task import Demand, Task

# Shares of an arm's length between which guidance away from the shoulder fades: of two links l as long as each other
# the share s leaves the elbow l sqrt(1 - s^2) of lever along the arm, a half of l at first and a third at last
_STRAIGHT = (0.85, 0.95)


class GuidanceGains(Settings):
    """Hand's following (A 12) and resting.

    Attributes:
        inertia: Lambda_3: hand's apparent mass.
        damping: D_3.
        gain: K_3 on arm forces.
        stiffness: Hand's hold without touch; 0 as in A, where arm weight errors cause drift. Critical is D_3^2 / (4
            Lambda_3).
        slack: Length beyond which that spring slips.
    """

    inertia: float = number(5.0, "kg", 1e-3, 1e3)
    damping: float = number(60.0, "N s/m", 0, 1e5)
    gain: float = number(1.0, "1", 0, 1e3)
    stiffness: float = number(0.0, "N/m", 0, 1e6)
    slack: float = number(0.03, "m", 0, 1)


class TactileGuidance(Task):
    """Hand's x''* = (K F_arm + k s - D x') / Lambda, F_arm the force on the arm (A 11, A 12 corrected).

    The spring k spans s, from hand to resting place, which a touch carries along.

    `point` (3,), own frame, in m; `arm`: three or more links, shoulder to wrist, at whose straight arm guidance ends;
    None for no such end.
    """

    def __init__(
        self,
        skin: BodySkin,
        patches: Sequence[str],
        link: str,
        point: NDArray[np.float64],
        gains: GuidanceGains | None = None,
        arm: Sequence[str] | None = None,
    ) -> None:
        if arm is not None and len(arm) < 3:
            raise InputError(f"an arm of the links {', '.join(arm)} cannot bend; allowed: three or more")
        self.gains = gains or GuidanceGains()
        self._touches = DirectInteraction(skin, self.gains.gain, patches)
        self._link = link
        self._point = np.asarray(point, dtype=float)
        self._arm = arm
        self._stretch = np.zeros(3)
        self._last: NDArray[np.float64] | None = None

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        if skin is None:
            return None
        gains = self.gains
        touches = self._touches.wrenches(skin)
        force = sum((robot.pose(link)[1] @ wrench[:3] for link, wrench, _ in touches), np.zeros(3))
        jacobian = robot.jacobian(self._link, self._point)[:3]
        pull = self._within_reach(robot, force) + gains.stiffness * self._kept(robot, bool(touches))
        wanted = (pull - gains.damping * (jacobian @ robot.velocity)) / gains.inertia
        return Demand(jacobian, acceleration=wanted, drift=robot.drift(self._link, self._point)[:3])

    def _within_reach(self, robot: RobotDynamics, force: NDArray[np.float64]) -> NDArray[np.float64]:
        # Force (3,) without the part that stretches a straight arm.
        if self._arm is None:
            return force
        joints = [robot.pose(link)[0] for link in self._arm]
        length = sum(float(np.linalg.norm(b - a)) for a, b in pairwise(joints))
        along = joints[-1] - joints[0]
        apart = float(np.linalg.norm(along))
        outward = float(force @ along)
        if outward <= 0.0:
            return force
        begin, end = _STRAIGHT
        share = minimum_jerk((end - apart / length) / (end - begin))[0]
        return force - (1.0 - share) * outward / apart**2 * along

    def _kept(self, robot: RobotDynamics, touched: bool) -> NDArray[np.float64]:
        # Stretch (3,) in m from hand to resting place.
        origin, rotation = robot.pose(self._link)
        place = origin + rotation @ self._point
        if self._last is not None and not touched:
            self._stretch = self._stretch - (place - self._last)
            self._stretch *= min(1.0, self.gains.slack / max(float(np.linalg.norm(self._stretch)), 1e-12))
        self._last = place
        return self._stretch
