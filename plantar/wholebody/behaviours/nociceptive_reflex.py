"""Nociceptive reflex: painful pressure drops tasks (T 3.4.1)."""

import math
from collections.abc import Sequence

from plantar.common.settings.schema import Settings, number
from plantar.wholebody.tasks.task import Task


class ReflexSettings(Settings):
    """Begin and end of the reflex.

    Attributes:
        threshold: Virtual force ||f_P|| of T 3.27 in N that drops tasks; 10 N in T.
        release: Share of the threshold below which they return.
        calm: Time in s below it.
    """

    threshold: float = number(10.0, "N", 0.0, 1e4)
    release: float = number(0.5, "1", 0.0, 1.0)
    calm: float = number(0.5, "s", 0.0, 60.0)


class NociceptiveReflex:
    """Two task arrangements, one current.

    `default`: levels without pain, the highest first; `reflex`: default levels without those that hold against the
    pressure. Attributes `active`: whether the reflex acts; `levels` the current ones.
    """

    def __init__(
        self,
        default: Sequence[Sequence[Task]],
        reflex: Sequence[Sequence[Task]],
        settings: ReflexSettings | None = None,
    ) -> None:
        self.settings = settings or ReflexSettings()
        self.active = False
        self._arrangements = (default, reflex)
        self._hurt = -math.inf

    @property
    def levels(self) -> Sequence[Sequence[Task]]:
        return self._arrangements[self.active]

    def update(self, virtual_force: float, time: float) -> bool:
        """Update with the virtual force; the reflex begins at once, ends after calm.

        `virtual_force`: norm of f_P of T 3.27 in N, the links' largest; `time` in s. Returns whether the arrangement
        changed: begin a priority transition.
        """
        s = self.settings
        before = self.active
        if virtual_force > (s.threshold * s.release if self.active else s.threshold):
            self.active = True
            self._hurt = time
        elif self.active and time - self._hurt >= s.calm:
            self.active = False
        return self.active != before
