"""Intentional contact: obstacles can be touched and pushed with tolerable force (T 3.4.2).

The conditions of T Table 1 overlap: an arrangement stays until another's have held a while.
"""

import math
from collections.abc import Sequence
from typing import ClassVar, Literal, NamedTuple

from plantar.common.settings.schema import Settings, number
from plantar.wholebody.tasks.task import Task

Arrangement = Literal["avoid", "approach", "retreat"]
"""T Table 1 a, b and c: obstacle avoidance, intentional approach and contact, hard contact reaction."""


class ContactSettings(Settings):
    """Thresholds of T Table 1, and times against chattering.

    Attributes:
        slow: epsilon_v in m/s below which the end effector is stuck.
        force_limit: epsilon_c in N from which it retreats.
        release: Share of the limit below which it tries again.
        stuck: Slow time in s before it approaches.
        retreat: Least time in s of a retreat.
        free: Time in s without contact or proximity before it avoids again.
        shrink: Time in s of the sensing range's shrinking to zero in approach, and growing back.
    """

    slow: float = number(0.02, "m/s", 0.0, 10.0)
    force_limit: float = number(10.0, "N", 1e-3, 1e4)
    release: float = number(0.5, "1", 0.0, 1.0)
    stuck: float = number(0.3, "s", 0.0, 60.0)
    retreat: float = number(0.3, "s", 0.0, 60.0)
    patience: ClassVar[float] = 2.0  # Time in s for which it presses on what does not move before it retreats
    free: float = number(0.5, "s", 0.0, 60.0)
    shrink: float = number(0.5, "s", 1e-3, 60.0)


class ContactSigns(NamedTuple):
    """Measurements that choose the arrangement.

    `speed`: ||x'|| of the end effector in m/s; `near`: ||f_p||: proximity's virtual force, whole range, in N;
    `contact`: ||f_c||: largest contact force on skin in N; `arrived`: whether the goal is reached, where it can rest.
    """

    speed: float
    near: float
    contact: float
    arrived: bool = False


class IntentionalContact:
    """Current arrangement, and used share of the sensing range.

    `goal`: tasks to the goal, tau_g of T 3.40; `contact`: tasks yielding to contact, tau_c of T 3.41; `avoidance`:
    tasks avoiding obstacles, tau_p of T 3.33. Attributes `range_share` of the sensing range for avoidance, 0 to 1.
    """

    def __init__(
        self,
        goal: Sequence[Task],
        contact: Sequence[Task],
        avoidance: Sequence[Task],
        settings: ContactSettings | None = None,
    ) -> None:
        self.settings = settings or ContactSettings()
        self.arrangement: Arrangement = "avoid"
        self.range_share = 1.0
        self._levels: dict[Arrangement, Sequence[Sequence[Task]]] = {
            "avoid": (avoidance, goal, contact),
            "approach": (goal, contact, avoidance),
            "retreat": (contact, goal, avoidance),
        }
        self._time = -math.inf
        # for how long what leads on has held, and what leads to a retreat
        self._held = 0.0
        self._pressed = 0.0

    @property
    def levels(self) -> Sequence[Sequence[Task]]:
        return self._levels[self.arrangement]

    def update(self, signs: ContactSigns, time: float) -> bool:
        """Update with new measurements `signs` at a `time` in s; a force over the limit counts at once.

        Returns whether the arrangement changed: begin a priority transition.
        """
        s = self.settings
        before = self.arrangement
        period = max(0.0, time - self._time) if math.isfinite(self._time) else 0.0
        self._time = time
        pressing = self.arrangement == "approach" and signs.contact > 0.0 and signs.speed <= s.slow
        self._pressed = self._pressed + period if pressing and not signs.arrived else 0.0
        if signs.contact >= s.force_limit or self._pressed > s.patience:
            self.arrangement = "retreat"
            self._held = 0.0
        else:
            leads_on, wait, following = self._way_on(signs)
            self._held = self._held + period if leads_on else 0.0
            if leads_on and self._held >= wait:
                self.arrangement = following
                self._held = 0.0
        step = period / s.shrink
        self.range_share = min(1.0, max(0.0, self.range_share + (step if self.arrangement != "approach" else -step)))
        return self.arrangement != before

    def _way_on(self, signs: ContactSigns) -> tuple[bool, float, Arrangement]:
        # Whether the arrangement's end condition holds, its time, and the next one.
        s = self.settings
        near = signs.near > 0.0
        touched = signs.contact > 0.0
        if self.arrangement == "avoid":
            return not signs.arrived and signs.speed <= s.slow and (near or touched), s.stuck, "approach"
        if self.arrangement == "retreat":
            return signs.contact < s.release * s.force_limit, s.retreat, "avoid"
        return not touched and (signs.arrived or not near), s.free, "avoid"
