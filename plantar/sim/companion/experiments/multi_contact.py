"""Thirteen contacts on a robot that stands on its left leg: it yields to each and keeps its balance (T 3.2.4.1)."""

from __future__ import annotations

from typing import Any, ClassVar

from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.pressed import UPPER_BODY, PressedExperiment

__all__ = ["MultiContact"]

_LEG = {f"right {part.replace('_', ' ')}": (f"right_{part}",) for part in ("upper_leg", "lower_leg", "foot_sole")}


class MultiContact(PressedExperiment):
    """Pads press on thirteen instances, one after the other, then on all of them.

    T 3.2.4.1 has support by the left leg, self-collision, skin, and a centre of mass at 0.8 m below it. Thirteen links
    that own all their rows leave nothing to a centre of mass below them, nor a spring that brings them back: in that
    order the free leg drifts under a push until the standing hip has not the torque to hold it. So the centre of mass
    stands with the support here, and skin and posture share the last level, as in T 3.2.3.1.
    """

    sides: ClassVar = ("left",)
    com_height: ClassVar = 0.8
    roll: ClassVar = -12.0
    instances: ClassVar = {**UPPER_BODY, **_LEG}

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.press_each()
        self.press_together(list(self.instances))
