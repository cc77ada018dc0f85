"""A standing machine under pads: it yields and keeps its balance."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number
from plantar.mujoco.foam_skins import FoamSkins
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sim.companion.experiment import Controller, Verdict, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.controller import StandingController
from plantar.sim.companion.standing.pad import Pad, PlannedContact, outer_taxel
from plantar.sim.companion.standing.standing import StandingExperiment, by_active
from plantar.wholebody.tasks.skin_interaction import DirectInteraction
from plantar.wholebody.tasks.task import Task

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
# s: when single contacts begin; each takes half a second to come near
_FIRST = 0.6
_APART = 1.0
_EACH = 1.5
_RESTS = 500  # physics steps of 1 ms after which it has settled, before anything presses
# s: contacts that press together, and of that both to grow and to fade
_TOGETHER = 4.6
_SWELLING = 1.5
_STRONGEST = 4.0  # times the force of a single contact


class PressedSettings(Settings):
    """Forces, and limits of yielding.

    Attributes:
        strength: Factor on single contacts' force; 1 presses with up to 3 % of body weight on an upper arm and 4 % on
            the torso.
        moment: Of all common contacts about the middle of the feet, as the centre of pressure's shift without leaning.
    """

    strength: float = number(1.0, "1", 0.0, 10.0)
    moment: float = number(0.13, "m", 0.0, 0.5)
    # Median yield of limbs over that of the posture's springs alone: half of the skin forces' gain
    yield_median: ClassVar[float] = 4.5
    yield_least: ClassVar[float] = 2.0  # Least yield of every limb, likewise


class PressedExperiment(StandingExperiment):
    """Pads press on the instances of a skin task. `instances`: instances of direct interaction and their patches."""

    settings_type: ClassVar = PressedSettings
    claims: ClassVar = {
        **StandingExperiment.claims,
        "yields": "every pressed limb yields more than by its posture's springs",
        "yields_median": "half of them yield several times as far",
    }
    columns: ClassVar = (
        "tilt_max_deg",
        "com_off_max_mm",
        "cop_margin_min_mm",
        "yield_least",
        "yield_median",
        "most_active",
    )
    # Instances of direct interaction and their patches.
    instances: ClassVar[Mapping[str, tuple[str, ...]]] = UPPER_BODY

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.contacts: list[PlannedContact] = []
        self._control: StandingController
        self._trace: list[tuple[float, ...]] = []

    def press_each(self) -> None:
        """Plan a contact on each instance, one after the other."""
        for i, name in enumerate(self.rng.permutation(list(self.instances)).tolist()):
            begin = _FIRST + i * _APART + self.rng.uniform(0.0, 0.1)
            self._press(name, self.instances[name], begin, _EACH)

    def _press(
        self, name: str, patches: Sequence[str], begin: float, hold: float, swell: float = 0.3
    ) -> PlannedContact:
        free = [p for p in patches if p not in ("torso_left", "torso_right")]
        patch = self.skin.patch(str(self.rng.choice(free)))
        kind = next(k for k in _SHARES if k in patch.name)
        force = _SHARES[kind] * self.weight * self.rng.uniform(0.6, 1.0) * self.settings.strength
        taxel = outer_taxel(self.robot, patch, "torso", self.rng)
        pad = Pad(name, patch, taxel, _FACES.get(kind, _FACE), 2e5 if kind in _TRUNK else 6e4)
        self.pads.append(pad)
        root = "torso" if name in UPPER_BODY else self.machine.base.link
        self.contacts.append(PlannedContact(pad, begin, hold, force, swell, "" if name in _TRUNK else root))
        return self.contacts[-1]

    def press_together(self, names: Sequence[str]) -> None:
        """Plan common contacts after single ones, trunk ones from front or back.

        They grow slowly beyond the moment that feet alone balance: the robot has to lean.
        """
        over = max(c.begin + c.hold for c in self.contacts)
        self.duration = over + _TOGETHER + 0.5
        face = str(self.rng.choice(["front", "back"]))
        together = []
        for name in names:
            patches = self.instances[name]
            faced = [p for p in patches if p.endswith(face)] if name in _TRUNK else patches
            begin = over + self.rng.uniform(0.0, 0.2)
            together.append(self._press(f"together {name}", faced, begin, _TOGETHER, _SWELLING))
        trunk = [c for c in together if c.pad.patch.name.startswith(_TRUNK)]
        limbs = self._moment([c for c in together if c not in trunk])
        factor = _reaching(limbs, self._moment(trunk), self.settings.moment)
        for contact in trunk:
            contact.force *= min(factor, _STRONGEST)

    def _moment(self, contacts: Sequence[PlannedContact]) -> NDArray[np.float64]:
        # Centre of pressure's shift (2,) in m by contacts in the first posture.
        middle = np.mean(list(self.stance.places.values()), axis=0)
        moment = np.zeros(3)
        for contact in contacts:
            place, inward = contact.pad.touching(self.robot)
            moment += np.cross(place - middle, contact.force * inward)
        return np.array([moment[1], -moment[0]]) / self.weight

    def _on_springs(self, contact: PlannedContact) -> float:
        # Posture springs' compliance in mm/N along a pad's normal.
        robot = self.robot
        pad = contact.pad
        place = pad.touching(robot)[0]
        origin, rotation = robot.pose(contact.against)
        root = robot.jacobian(contact.against, rotation.T @ (place - origin))[:3]
        own = robot.jacobian(pad.patch.link, pad.middle)[:3] - root
        row = own.T @ robot.pose(pad.patch.link)[1] @ pad.inward
        return 1e3 * float((row[robot.joints] ** 2 / self.posture_task().stiffness).sum())

    def levels(self, skin: BodySkin) -> list[list[Task]]:
        """Tasks by priority: balance; distance of links and joints; skin and posture."""
        yielding = [DirectInteraction(skin, self.control.gain, patches) for patches in self.instances.values()]
        apart: list[Task] = [self.self_collision_task(), self.joint_range_task()]
        return [self.balance_tasks(), apart, [*yielding, self.posture_task()]]

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        levels = self.levels(skin)
        self._control = StandingController(self.stance, levels, self.balance, skin, self.control)
        return self._control

    def act(self, world: World, time: float) -> None:
        for contact in self.contacts:
            contact.act(time, self.pressing(contact.pad))
        super().act(world, time)

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        super().judge(world, sensor, time)
        if self._steps == _RESTS:
            for contact in self.contacts:
                contact.rest = contact.place(world)
        forces = [self.pressing(c.pad) for c in self.contacts]
        for contact, force in zip(self.contacts, forces, strict=True):
            contact.judge(world, force)
        if self._steps % 20 == 0:
            self._trace.append((time, *forces))

    def verdict(self) -> Verdict:
        s = self.settings
        single = [c for c in self.contacts if "together" not in c.pad.name]
        times = {c.pad.name: c.compliance / self._on_springs(c) for c in single if c.against}
        name, least = min(times.items(), key=lambda item: item[1])
        middle = float(np.median(list(times.values())))
        found = f"{name} yields {least:.2g} times as far as on springs; wanted: {s.yield_least:g}"
        median = f"limbs yield {middle:.2g} times as far as on springs; wanted: {s.yield_median:g}"
        reasons = self.balance_reasons() + unmet(
            (least >= s.yield_least, "yields", least, s.yield_least, found),
            (middle >= s.yield_median, "yields_median", middle, s.yield_median, median),
        )
        figures = {
            **self.balance_figures(),
            "yield_least": round(least, 2),
            "yield_median": round(middle, 2),
            "compliance_mm_N": {c.pad.name: round(c.compliance, 3) for c in self.contacts},
            "force_max_N": {c.pad.name: round(c.measured, 1) for c in self.contacts},
            "most_active": max(self._control.active, default=0),
            "control_us_by_active": dict(by_active(self._control.took, self._control.active)),
        }
        return Verdict(reasons, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        trace = np.array(self._trace)
        figure, (upper, lower) = new_figure(9.0, 7.0, rows=2)
        places = list(self.instances)
        for i, contact in enumerate(self.contacts):
            place = places.index(contact.pad.name.removeprefix("pad ").removeprefix("together "))
            looks = {"color": f"C{place % 10}", "linestyle": ("-", "--")[place // 10], "linewidth": 1.0}
            upper.plot(trace[:, 0], trace[:, 1 + i], label=places[place] if i < len(places) else None, **looks)
        upper.set(xlabel="time [s]", ylabel="force of each pad [N]")
        upper.legend(fontsize=7, ncols=2, title="alone, then together", title_fontsize=7)
        active = np.array(self._control.active)
        took = np.array(self._control.took[: len(self._control.active)])
        if len(took):
            apart = np.random.default_rng(0).uniform(-0.2, 0.2, len(active))
            lower.plot(active + apart, took, ".", markersize=1.5, color=COLOURS["edge"])
            medians = by_active(self._control.took, self._control.active)
            lower.plot([int(n) for n in medians], list(medians.values()), "o-", color=COLOURS["right"], label="median")
            lower.set(ylim=(0.0, 1.1 * float(np.percentile(took, 99))))
            lower.legend()
        lower.set(xlabel="links with active taxels", ylabel="control tick [us]")
        return [save_figure(figure, folder / f"{type(self).__name__.lower()}.png")]


def _reaching(fixed: NDArray[np.float64], scaled: NDArray[np.float64], length: float) -> float:
    # Factor k at which |fixed + k scaled| is a length; 0 where longer.
    a = float(scaled @ scaled)
    b = float(fixed @ scaled)
    c = float(fixed @ fixed) - length**2
    return max(0.0, (-b + math.sqrt(max(0.0, b * b - a * c))) / a)
