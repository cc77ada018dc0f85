"""A standing machine that pads press on at many places: it yields to each and keeps its balance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from plantar.mechanics.lip import GRAVITY
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.settings.schema import Settings, number
from sim.companion.experiment import Controller, Verdict, World, failed
from sim.companion.machine import Machine
from sim.companion.skin_sensing import SkinSensor
from sim.companion.skin_surface import skin_from_tables
from sim.companion.standing.contacts import PlannedContact, outer_taxel
from sim.companion.standing.controller import StandingController
from sim.companion.standing.pad import Pad
from sim.companion.standing.standing import StandingExperiment, by_active
from wholebody.tasks.interaction import DirectInteraction
from wholebody.tasks.task import Task

__all__ = ["UPPER_BODY", "PressedExperiment", "PressedSettings"]

UPPER_BODY: Mapping[str, tuple[str, ...]] = {
    **{
        f"{side} {part.replace('_', ' ')}": (f"{side}_{part}",)
        for side in ("left", "right")
        for part in ("upper_arm", "lower_arm", "hand_palm", "hand_back")
    },
    "torso": ("torso_front", "torso_back", "torso_left", "torso_right"),
    "hip": ("hip_front", "hip_back"),
}
"""The ten instances of T 3.2.3.1 and their patches."""

_SHARES = {"upper_arm": 0.03, "lower_arm": 0.02, "hand": 0.012, "torso": 0.04, "hip": 0.04, "leg": 0.015, "foot": 0.015}
_TRUNK = ("torso", "hip")
_FACES = {"torso": 0.07, "hip": 0.06}  # m: radius; elsewhere _FACE
_FACE = 0.04


class PressedSettings(Settings):
    """How hard it is pressed, and what counts as yielding.

    Attributes:
        strength: Factor on all forces; 1 presses with up to 3 % of body weight on an upper arm and 4 % on the torso.
        yield_limb: Compliance that arms, hands and a free leg need to have at least.
        yield_trunk: Compliance that torso and hips need to have at least; they lean into a push, so none is asked for.
    """

    strength: float = number(1.0, "1", 0.0, 10.0)
    yield_limb: float = number(0.1, "mm/N", 0.0, 100.0)
    yield_trunk: float = number(0.0, "mm/N", 0.0, 100.0)


class PressedExperiment(StandingExperiment):
    """Pads press on the instances of a skin task.

    Attributes:
        skin: The machine's skin.
        contacts: What presses when.
    """

    settings_type: ClassVar = PressedSettings
    columns: ClassVar = ("tilt_max_deg", "com_off_max_mm", "cop_margin_min_mm", "compliance_min", "most_active")
    instances: ClassVar[Mapping[str, tuple[str, ...]]] = UPPER_BODY
    """Instances of direct interaction and their patches."""

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.skin = skin_from_tables(self.robot.model, machine.patches, machine.name)
        self.contacts: list[PlannedContact] = []
        self._control: StandingController | None = None
        self._trace: list[tuple[float, ...]] = []

    def press(self, name: str, patches: Sequence[str], begin: float, hold: float) -> None:
        """Plan a contact on one of some patches, with a force and at a taxel of the seed.

        Args:
            name: Name of the contact.
            patches: Names of the patches; those at the sides of the trunk, inside of the arms, are left out.
            begin: Time in s at which it begins.
            hold: Time in s for which it presses.
        """
        free = [p for p in patches if p not in ("torso_left", "torso_right")]
        patch = self.skin.patch(str(self.rng.choice(free)))
        kind = next(k for k in _SHARES if k in patch.name)
        weight = GRAVITY * float(self.robot.model.body_subtreemass[0])
        force = _SHARES[kind] * weight * self.rng.uniform(0.6, 1.0) * self.settings.strength
        face = _FACES.get(kind, _FACE)
        taxel = outer_taxel(self.robot, patch, "torso", self.rng)
        pad = Pad(name, patch, taxel, face, 2e5 if kind in _TRUNK else 6e4)
        self.pads.append(pad)
        self.contacts.append(PlannedContact(pad, begin, hold, force))

    def levels(self, skin: BodySkin) -> list[list[Task]]:
        """Tasks by priority: balance, what keeps links and joints apart, and last skin and posture together."""
        yielding = [DirectInteraction(skin, self.control.gain, patches) for patches in self.instances.values()]
        apart: list[Task] = [self.self_collision_task(), self.joint_range_task()]
        return [self.balance_tasks(), apart, [*yielding, self.posture_task()]]

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        levels = self.levels(skin)
        self._control = StandingController(self.stance, levels, self.balance, skin, self.control)
        return self._control

    def act(self, world: World, time: float) -> None:
        for contact in self.contacts:
            contact.act(time)
        super().act(world, time)

    def judge(self, world: World, sensor: SkinSensor, time: float) -> None:
        super().judge(world, sensor, time)
        forces = [self.pressing(c.pad) for c in self.contacts]
        for contact, force in zip(self.contacts, forces, strict=True):
            contact.judge(world, force)
        if self._steps % 20 == 0:
            self._trace.append((time, *forces))

    def verdict(self) -> Verdict:
        reasons = self.balance_reasons()
        single = [c for c in self.contacts if "together" not in c.pad.name]
        for contact in single:
            trunk = contact.pad.patch.name.startswith(_TRUNK)
            least = self.settings.yield_trunk if trunk else self.settings.yield_limb
            if contact.compliance < least:
                text = f"{contact.pad.name} yields by {contact.compliance:.2f} mm/N; wanted: {least:g}"
                reasons.append(failed("yields", contact.compliance, least, text))
        assert self._control is not None
        figures = {
            **self.balance_figures(),
            "compliance_min": round(min(c.compliance for c in single), 3),
            "compliance_median": round(float(np.median([c.compliance for c in single])), 3),
            "compliance_mm_N": {c.pad.name: round(c.compliance, 3) for c in self.contacts},
            "force_max_N": {c.pad.name: round(c.felt, 1) for c in self.contacts},
            "most_active": max(self._control.active, default=0),
            "control_us_by_active": dict(by_active(self._control.took, self._control.active)),
        }
        return Verdict(reasons, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        assert self._control is not None
        trace = np.array(self._trace)
        figure, (upper, lower) = new_figure(9.0, 7.0, rows=2)
        for i, contact in enumerate(self.contacts):
            upper.plot(trace[:, 0], trace[:, 1 + i], linewidth=1.0, label=contact.pad.name)
        upper.set(xlabel="time [s]", ylabel="force of each pad [N]")
        upper.legend(fontsize=5, ncols=2)
        active, took = np.array(self._control.active), np.array(self._control.took[: len(self._control.active)])
        if len(took):
            apart = np.random.default_rng(0).uniform(-0.2, 0.2, len(active))
            lower.plot(active + apart, took, ".", markersize=1.5, color=COLOURS["edge"])
            medians = by_active(self._control.took, self._control.active)
            lower.plot([int(n) for n in medians], list(medians.values()), "o-", color=COLOURS["right"], label="median")
            lower.set(ylim=(0.0, 1.1 * float(np.percentile(took, 99))))
            lower.legend()
        lower.set(xlabel="links with active taxels", ylabel="control tick [us]")
        name = type(self).__name__.lower()
        return [save_figure(figure, folder / f"{name}.png")]
