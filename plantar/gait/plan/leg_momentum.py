"""Shift of a walk's plan by the angular momentum of its legs.

A CoM c at height h, with the robot's angular momentum L about it, has its ZMP at

    p = c - h/g c'' + (-L_y', L_x') / (m g).

With the trunk upright only the legs turn about the CoM. A foot f that moves relative to it gives (-L_y, L_x) = m g D
(f' - c'), D in s^2 that of a leg (`plantar.robots.kinematics.leg_inertia`), and both feet together

    p = c - (h/g + 2 D) c'' + D f'',

f'' that of the swinging foot: a pendulum of frequency w = (h/g + 2 D)^(-1/2) over the VRP p - D f''. Its equations are
linear: to DCM and CoM of the planned VRP p come those of the VRP -D f'', by which the body leans ahead of a swing.
"""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.gait.plan.vrp_plan import LipReference, VrpPlan
from plantar.gait.plan.walk_plan import PlanView, WalkPlan
from plantar.kernels.gait import leg_shift
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.same_time import SAME_TIME

_AHEAD = 4  # derived: steps that count: later ones move the CoM by micrometres
_HELD = 0.06  # of a swing, at its start, in which the foot only rises; derived: `_END` of the swing flight
# nature: minimum-jerk s''
_KNOTS = tuple((k / 6, 60 * (k / 6) - 180 * (k / 6) ** 2 + 120 * (k / 6) ** 3) for k in range(7))
EARLY = 0.75
"""Share of a swing after which its foot only descends, with time to spare. Derived: 1 - `_EARLY_END` of its flight."""

LATEST = 0.94
"""The same at most. Derived: 1 - `_END` of its flight."""

# derived: m of way over s^2 of time, of a minimum jerk whose peak a hip takes: 0.7 g
_BRISK = 0.07 * math.sqrt(3.0) * GRAVITY
_FADES = 1.0  # chosen: s after the last swing in which nothing is left


def haste(way: float, duration: float) -> float:
    """Returns the share 0..1 of its time after arrival that a swing of `duration` in s takes for a `way` in m."""
    needed = _HELD + math.sqrt(way / _BRISK) / duration
    return min(1.0, max(0.0, (needed - EARLY) / (LATEST - EARLY)))


class LegMomentum:
    """DCM and CoM by swinging legs, to be added to a plan's.

    `omega`: frequency of the pendulum with legs in rad/s; `inertia`: D in s^2; 0 shifts nothing; `arrived`: share of a
    swing without `haste` after which its foot only descends.
    """

    def __init__(self, plan: WalkPlan, omega: float, inertia: float, arrived: float) -> None:
        self._plan = plan
        self._omega = omega
        self._inertia = inertia
        self._arrived = arrived
        self._shift = VrpPlan((0.0, _FADES), np.zeros((2, 2)), omega)
        self._view: PlanView | None = None  # of which the shift was solved
        self._until = math.inf

    def at(self, time: float) -> LipReference:
        """The shift at a time in s, its VRP that of the swinging leg alone."""
        if self._inertia and (self._plan.view is not self._view or time >= self._until):
            self._look_ahead(time)
        return self._shift.at(time)

    def accelerations(
        self, reference: LipReference, shift: LipReference
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Planned with a `shift`, (2,) in m/s^2: the CoM's, and f'' of the swinging foot; 0 without inertia."""
        if not self._inertia:
            return reference.com_acceleration, shift.vrp
        com, foot = leg_shift.accelerations(reference, shift, self._inertia)
        return com, foot

    def dcms(self, state: BaseState, shift: LipReference) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """A state's DCM (2,) in m (T 4.27), and that of the pendulum that is planned, without a `shift`."""
        whole, own = leg_shift.dcms(state, shift, self._omega)
        return whole, own

    def added(
        self, com: NDArray[np.float64], acceleration: NDArray[np.float64], shift: LipReference
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Returns a pendulum's `com` (2,) in m and `acceleration` (2,) in m/s^2 with a `shift`, and (-L_y', L_x')
        / (m g) (2,) in m that the feet's forces give.
        """
        place, rate, momentum = leg_shift.added(com, acceleration, shift, self._inertia)
        return place, rate, momentum

    def _look_ahead(self, time: float) -> None:
        """Solve the next swings' shift from the CoM's now."""
        view = self._plan.view
        self._view = view
        now = self._shift.at(time)
        schedule = view.schedule
        times = [time]
        points = [now.vrp]
        first = schedule.at(time).step
        self._until = math.inf
        for phase in schedule.phases[schedule.index(time) :]:
            if phase.swing is None:
                continue
            if phase.step == first + _AHEAD:
                break
            if phase.step == first + 1:
                self._until = phase.end
            lasts = phase.touchdown - phase.start
            way = view.vrp(phase.step) - view.vrp_before(phase.step, phase.swing)
            begin = phase.start + _HELD * lasts
            late = haste(math.hypot(*way.tolist()), lasts)
            lasts *= self._arrived + late * (LATEST - self._arrived) - _HELD
            for share, acceleration in _KNOTS:
                if begin + share * lasts > times[-1] + SAME_TIME:
                    times.append(begin + share * lasts)
                    points.append(-self._inertia * acceleration / lasts**2 * way)
        self._shift = VrpPlan((*times, times[-1] + _FADES), np.array([*points, np.zeros(2)]), self._omega, now.com)
