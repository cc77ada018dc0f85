"""Thirteen contacts on a robot on its left leg: it yields and keeps its balance (T 3.2.4.1)."""

from __future__ import annotations

from typing import Any, ClassVar

from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.pressed import UPPER_BODY, PressedExperiment

__all__ = ["MultiContact"]

_LEG = {f"right {part.replace('_', ' ')}": (f"right_{part}",) for part in ("upper_leg", "lower_leg", "foot_sole")}


class MultiContact(PressedExperiment):
    """Pads press on thirteen instances in turn, then on all.

    T 3.2.4.1 has the center of mass below the skin, which leaves no direction for it. Here it shares the support's
    level.
    """

    sides: ClassVar = ("left",)
    com_height: ClassVar = 0.8
    roll: ClassVar = -12.0
    instances: ClassVar = {**UPPER_BODY, **_LEG}

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.press_each()
        self.press_together(list(self.instances))
