"""A painful pressure makes the robot give up its hand's pose (T 3.4.1.1).

Order: support; right hand's position; its orientation; pressure-driven compliance; posture. Above 10 N of virtual force
the hand's tasks are dropped until it is calm.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from plantar.common.settings.schema import Settings, number, switch
from plantar.mujoco.foam_skins import FoamSkins
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import Controller, Verdict, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.controller import StandingControl, StandingController
from plantar.sim.companion.standing.pad import Pad
from plantar.sim.companion.standing.standing import StandingExperiment
from plantar.wholebody.behaviours.nociceptive_reflex import NociceptiveReflex, ReflexSettings
from plantar.wholebody.fusion.priority_transition import PriorityTransition
from plantar.wholebody.tasks.cartesian_pose import CartesianPose
from plantar.wholebody.tasks.skin_interaction import PressureInteraction
from plantar.wholebody.tasks.task import Task

_PATCH = "right_hand_back"
_LINK = "right_hand"
_FACES = {"one": 0.010, "seven": 0.035}  # m: radius; seven taxels are one and the six about it
_CHANGING = 0.1  # s after a change of priorities in which torques are looked at
_RATE = 6.0  # N/s: how fast a probe presses harder, times its taxels
# s: a probe's time, how long it goes on once the hand gives way, and a pause
_PHASE = 5.0
_HOLD = 0.6
_REST = 2.0


class NociceptionSettings(Settings):
    """Requirements of the reflex.

    Attributes:
        tolerance: Largest deviation of threshold force ratio from area ratio.
    """

    tolerance: float = number(0.1, "1", 0.0, 1.0)
    # Largest change of a joint's torque in one period while priorities change, as a share of its limit; noise makes 8 %
    jump: ClassVar[float] = 0.06
    retreat: ClassVar[float] = 0.03  # How far the hand has to give way, in m


class NociceptionControl(StandingControl):
    """How the reflex acts.

    Attributes:
        reflex: Whether there is a reflex.
        smooth: Whether priorities change smoothly.
        threshold: Virtual force that hurts.
    """

    reflex: bool = switch(True)
    smooth: bool = switch(True)
    threshold: float = number(10.0, "N", 0.1, 1000.0)
    sensitivity_taxels: ClassVar[float] = 3.0  # xi of T 3.27 in areas of a taxel
    yield_damping: ClassVar[float] = 60.0  # N s/m: damping of the hand while it yields
    filter: float = number(0.02, "s", 0.0, 1.0)


@dataclass
class _Probe:
    pad: Pad
    taxels: int
    begin: float
    triggered: float = float("nan")
    since: float = float("inf")
    moved: float = 0.0


class Nociception(StandingExperiment):
    """Two probes, in random order, press ever harder on the right hand's back."""

    settings_type: ClassVar = NociceptionSettings
    control_type: ClassVar = NociceptionControl
    claims: ClassVar = {
        **StandingExperiment.claims,
        "threshold_ratio": "the reflex comes at forces that differ as the areas do",
        "torque_jump": "no torque jumps as tasks are dropped",
        "retreat": "the hand gives way",
    }
    columns: ClassVar = ("threshold_ratio", "torque_jump", "moved_mm", "cop_margin_min_mm")

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        patch = self.skin.patch(_PATCH)
        middle = int(patch.from_middle[0])
        self.rate = _RATE * self.rng.uniform(0.7, 1.3)
        self.probes: dict[str, _Probe] = {}
        for i, name in enumerate(list(_FACES)[:: int(self.rng.choice([-1, 1]))]):
            count = 1 if name == "one" else 7
            pad = Pad(name, patch, middle, _FACES[name], 7e3 * count)
            self.pads.append(pad)
            self.probes[name] = _Probe(pad, count, 0.5 + i * (_PHASE + _REST) + self.rng.uniform(0.0, 0.3))
        self.duration = 0.5 + 2 * (_PHASE + _REST)
        self._rest = self.robot.pose(_LINK)[0]
        self._control: StandingController
        self._virtual = 0.0
        self._last: Any = None
        self._jump = 0.0
        self._changed = -np.inf
        self._trace: list[tuple[float, ...]] = []
        self.reflex = NociceptiveReflex([], [])
        self.transition = PriorityTransition()

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        c = self.control
        self._pressure = PressureInteraction(skin, c.sensitivity_taxels * float(skin.areas[0]))
        self._pressure.damping = (c.yield_damping, 0.02 * c.yield_damping)
        position, orientation = (CartesianPose(_LINK, rows=rows) for rows in ("position", "orientation"))
        base: list[Task] = self.balance_tasks()
        default: list[list[Task]] = [base, [position], [orientation], [self._pressure], [self.posture_task()]]
        settings = ReflexSettings(threshold=c.threshold)
        self.reflex = NociceptiveReflex(default, [base, default[3], default[4]], settings)
        self._control = StandingController(self.stance, default, self.balance, skin, c, self._before)
        self._control.after = self._after
        return self._control

    def _before(self, robot: MujocoDynamics, measured: Reading) -> None:
        strongest = [float(np.linalg.norm(w.wrench[:3])) for w in self._pressure.wrenches(measured)]
        before = self._virtual
        self._virtual = max(strongest, default=0.0)
        if self.control.reflex and self.reflex.update(self._virtual, robot.time):
            self._control.stack.levels = [list(level) for level in self.reflex.levels]
        elif (before > 0.0) == (self._virtual > 0.0):
            return
        self._changed = robot.time
        self.transition.begin(robot.time)

    def _after(self, torque: Any, time: float) -> Any:
        found = self.transition.blend(torque, time) if self.control.smooth else torque
        if self._last is not None and time - self._changed < _CHANGING:
            self._jump = max(self._jump, float((np.abs(found - self._last) / self.machine.efforts).max()))
        self._last = found
        return found

    def act(self, world: World, time: float) -> None:
        for probe in self.probes.values():
            pressing = probe.begin <= time < min(probe.begin + _PHASE, probe.since + _HOLD)
            rising = max(0.0, min(time, probe.since) - probe.begin - 0.8)
            probe.pad.wanted = 0.5 * probe.taxels + self.rate * rising * probe.taxels / 4.0 if pressing else 0.0
        super().act(world, time)

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        super().judge(world, sensor, time)
        moved = float(np.linalg.norm(world.pose(_LINK)[0] - self._rest))
        for probe in self.probes.values():
            if probe.begin <= time < probe.begin + _PHASE + 0.5:
                probe.moved = max(probe.moved, moved)
                if self.reflex.active and not np.isfinite(probe.triggered):
                    probe.triggered = self.pressing(probe.pad)
                    probe.since = time
        if self._steps % 10 == 0:
            force = sum(self.pressing(p.pad) for p in self.probes.values())
            self._trace.append((time, force, self._virtual, 1e3 * moved, float(self.reflex.active)))

    def verdict(self) -> Verdict:
        s = self.settings
        one = self.probes["one"]
        seven = self.probes["seven"]
        ratio = seven.triggered / one.triggered
        off = abs(ratio / 7.0 - 1.0) if np.isfinite(ratio) else 1.0
        moved = min(p.moved for p in self.probes.values())
        apart = f"threshold forces differ by {ratio:.2f}, areas by 7; allowed: {s.tolerance:.0%} apart"
        jump = f"a torque jumped by {self._jump:.1%} of its limit in one period; allowed: {s.jump:.1%}"
        retreat = f"the hand gave way by {1e3 * moved:.0f} mm; wanted: {1e3 * s.retreat:.0f}"
        reasons = self.balance_reasons() + unmet(
            (off <= s.tolerance, "threshold_ratio", off, s.tolerance, apart),
            (self._jump <= s.jump, "torque_jump", self._jump, s.jump, jump),
            (moved >= s.retreat, "retreat", moved, s.retreat, retreat),
        )
        figures = {
            **self.balance_figures(),
            "threshold_ratio": round(ratio, 3) if np.isfinite(ratio) else None,
            "threshold_forces_N": {
                name: round(p.triggered, 2) if np.isfinite(p.triggered) else None for name, p in self.probes.items()
            },
            "torque_jump": round(self._jump, 4),
            "moved_mm": round(1e3 * moved, 1),
        }
        return Verdict(reasons, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        time, force, virtual, moved, active = np.array(self._trace).T
        figure, (upper, lower) = new_figure(8.0, 5.0, rows=2, sharex=True)
        upper.plot(time, force, color=COLOURS["truth"], label="probe")
        upper.plot(time, virtual, color=COLOURS["active"], label="virtual force")
        upper.axhline(self.control.threshold, color=COLOURS["reference"], linestyle="--", label="threshold")
        upper.fill_between(time, 0.0, 1.1 * max(force.max(), virtual.max()) * active, alpha=0.15, label="reflex")
        upper.set(ylabel="force [N]")
        upper.legend()
        lower.plot(time, moved, color=COLOURS["left"])
        lower.set(xlabel="time [s]", ylabel="hand moved [mm]")
        return [save_figure(figure, folder / "nociception.png")]
