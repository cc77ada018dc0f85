"""Thirteen contacts on a robot on its left leg: it avoids, yields and keeps its balance (T 3.2.4.1)."""

from typing import Any, ClassVar

from plantar.common.settings.schema import switch
from plantar.sensing.link_skin import BodySkin
from plantar.sim.companion.experiments.feather import FeatherControl
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.pressed import UPPER_BODY, PressedExperiment
from plantar.wholebody.tasks.skin_interaction import ProximityInteraction
from plantar.wholebody.tasks.task import Task

_LEG = {f"right {part.replace('_', ' ')}": (f"right_{part}",) for part in ("upper_leg", "lower_leg", "foot_sole")}


class MultiContactControl(FeatherControl):
    """How the machine yields.

    Attributes:
        com_below: Whether the center of mass is below the skin.
    """

    com_below: bool = switch(False)


class MultiContact(PressedExperiment):
    """Pads press on thirteen instances in turn, then on all; 13 tasks of contact and 13 of proximity run (T 5.1).

    The center of mass shares the support's level. Below the skin, as T 3.2.4.1 has it, the robot falls, probably since
    a touched upper arm takes six directions, of which shoulder and waist have five.
    """

    control_type: ClassVar = MultiContactControl
    sides: ClassVar = ("left",)
    com_height: ClassVar = 0.8
    roll: ClassVar = -12.0
    instances: ClassVar = {**UPPER_BODY, **_LEG}

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.press_each()
        self.press_together(list(self.instances))

    def levels(self, skin: BodySkin) -> list[list[Task]]:
        (com, upright), apart, yielding = super().levels(skin)
        c = self.control
        near = [ProximityInteraction(skin, c.stiffness, c.range, patches) for patches in self.instances.values()]
        for task in near:
            task.damping = (c.repelled_damping, 0.02 * c.repelled_damping)
        touched: list[Task] = [*near, *yielding] if c.proximity else yielding
        if c.com_below:
            return [[upright], apart, touched[:-1], [com], touched[-1:]]
        return [[com, upright], apart, touched]
