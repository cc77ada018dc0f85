"""Many hands press on a standing robot, and hug it; it keeps its balance (T 3.2.3.1)."""

from typing import Any

from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.pressed import PressedExperiment

_HANDS = ("hand palm", "hand back")


class Hug(PressedExperiment):
    """Pads press on ten instances, then on torso, hips and arms together."""

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.press_each()
        self.press_together([name for name in self.instances if not name.endswith(_HANDS)])
