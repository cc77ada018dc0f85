"""Many hands press on a standing robot, and hug it: it yields to each and keeps its balance (T 3.2.3.1)."""

from __future__ import annotations

from typing import Any

from sim.companion.machine import Machine
from sim.companion.standing.pressed import PressedExperiment

__all__ = ["Hug"]

_HUGGING = (*("torso_front", "torso_back", "left_upper_arm", "right_upper_arm", "left_lower_arm", "right_lower_arm"),)


class Hug(PressedExperiment):
    """Pads press on all ten instances at times of the seed; then those of torso and arms press together.

    The order of T 3.2.3.1: support and balance, self-collision, and last skin and posture together.
    """

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.duration = 9.5
        for name, patches in self.instances.items():
            self.press(name, patches, self.rng.uniform(0.6, 2.0), self.rng.uniform(1.8, 3.0))
        begin = self.rng.uniform(5.8, 6.2)
        for patch in _HUGGING:
            self.press(f"together {patch.replace('_', ' ')}", [patch], begin + self.rng.uniform(0.0, 0.3), 2.5)
