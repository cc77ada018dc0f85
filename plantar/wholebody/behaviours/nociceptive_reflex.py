"""Nociceptive reflex: tasks are dropped under painful pressure (T 3.4.1)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from plantar.settings.schema import Settings, number
from plantar.wholebody.tasks.task import Task

__all__ = ["NociceptiveReflex", "ReflexSettings"]


class ReflexSettings(Settings):
    """When the reflex begins and ends.

    Attributes:
        threshold: Virtual force ||f_P|| of T 3.27 in N above which tasks are dropped; 10 N in T.
        release: Share of the threshold below which the force has to fall before they are taken up again.
        calm: Time in s that it has to stay there.
    """

    threshold: float = number(10.0, "N", 0.0, 1e4)
    release: float = number(0.5, "1", 0.0, 1.0)
    calm: float = number(0.5, "s", 0.0, 60.0)


class NociceptiveReflex:
    """Two arrangements of tasks, and the current one.

    Args:
        default: Levels without pain, the highest first.
        reflex: Levels of the reflex: the default ones without those that hold the body against the pressure.
        settings: When it begins and ends.

    Attributes:
        active: Whether the reflex counts; `levels` the current ones.
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
        """Update with the virtual force; the reflex begins at once and ends after a calm.

        Args:
            virtual_force: Norm of f_P of T 3.27 in N, the largest of all links.
            time: Time in s.

        Returns:
            Whether the arrangement has changed: then a transition of priorities begins.
        """
        s, before = self.settings, self.active
        if virtual_force > (s.threshold * s.release if self.active else s.threshold):
            self.active, self._hurt = True, time
        elif self.active and time - self._hurt >= s.calm:
            self.active = False
        return self.active != before
