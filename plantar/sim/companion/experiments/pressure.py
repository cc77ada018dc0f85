"""Probes of one and a hundred taxels press on the torso with the same force: the area decides (T 3.2.5.1)."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number, switch
from plantar.mujoco.foam_skins import FoamSkins
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sim.companion.experiment import Controller, Verdict, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.controller import StandingControl, StandingController
from plantar.sim.companion.standing.pad import Pad
from plantar.sim.companion.standing.standing import StandingExperiment
from plantar.wholebody.tasks.skin_interaction import DirectInteraction, PressureInteraction
from plantar.wholebody.tasks.task import Task

# the joints that carry the torso
_PATCH = "torso_front"
_JOINTS = ("waist_yaw", "waist_pitch")
_FACES = {"one": 0.010, "hundred": 0.148}  # m: radius; a taxel's inner radius is 14 mm
# When a probe is measured, in s from its full force on. Noise of the gyro, 2 mrad/s in each tick, is damped like
# motion and lets torso and pelvis drift: by up to 6 % of the slow speed in 14.4 s, and, as a random walk, by 0.7 of
# that in twice the time.
_WINDOWS = {"one": (0.35, 0.55), "hundred": (0.8, 30.2)}
_PRESS = {"one": 4.0, "hundred": 32.5}  # s
_REST = 1.6  # s


class PressureSettings(Settings):
    """Force of the probes.

    Attributes:
        force: Mean force of both as a share of body weight; each seed has its own.
        tolerance: Largest deviation from the area law.
    """

    force: float = number(0.028, "1", 0.001, 0.2)
    tolerance: float = number(0.1, "1", 0.0, 1.0)


class PressureControl(StandingControl):
    """How the machine yields.

    Attributes:
        by_pressure: Whether the area counts; otherwise the force alone, as if on `sensitivity_taxels`.
    """

    by_pressure: bool = switch(True)
    sensitivity_taxels: ClassVar[float] = 12.0  # xi of T 3.27 in areas of a taxel: over so many a force counts as it is
    # N s/m: damping of the torso while it yields. With the sensitivity it describes how fast 1 N moves the torso;
    # both larger, what is wrong with 97 taxels' calibration and noise of the gyro count for less, until the force
    # that is fed back through the skin's delay lets the probe chatter (from 16 taxels on)
    yield_damping: ClassVar[float] = 9000.0


@dataclass
class _Push:
    pad: Pad
    begin: float
    end: float
    full: float = np.inf
    taxels: list[float] = field(default_factory=list)
    forces: list[float] = field(default_factory=list)
    window: tuple[float, float] = (0.0, 0.0)
    times: list[float] = field(default_factory=list)
    joints: list[NDArray[np.float64]] = field(default_factory=list)

    @property
    def speed(self) -> float:
        """Norm of waist joint velocities in rad/s in the window, or NaN."""
        if len(self.times) < 2:
            return float("nan")
        return float(np.linalg.norm(np.polyfit(self.times, np.array(self.joints), 1)[0]))


class Pressure(StandingExperiment):
    """Two probes in random order and place; tasks as in T 3.2.5.1.

    The balance holds the base: the torso moves about the waist alone.
    """

    settings_type: ClassVar = PressureSettings
    control_type: ClassVar = PressureControl
    claims: ClassVar = {
        **StandingExperiment.claims,
        "area_law": "it yields as fast as the pressed areas differ",
    }
    columns: ClassVar = ("speed_ratio", "area_ratio", "cop_margin_min_mm")

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        patch = self.skin.patch(_PATCH)
        taxel = int(self.rng.choice(patch.from_middle[:5]))
        self.force = settings.force * self.weight * self.rng.uniform(0.85, 1.15)
        order = list(_FACES)[:: int(self.rng.choice([-1, 1]))]
        self._pushes = {}
        begin = 0.5
        for name in order:
            pad = Pad(name, patch, taxel, _FACES[name], 7e3 if name == "one" else 7e5)
            self.pads.append(pad)
            self._pushes[name] = _Push(pad, begin, begin + _PRESS[name], window=_WINDOWS[name])
            begin += _PRESS[name] + _REST
        self.duration = begin
        self._slice = self.skin.slices[_PATCH]
        self._trace: list[tuple[float, float, float]] = []

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        c = self.control
        if c.by_pressure:
            task: DirectInteraction = PressureInteraction(skin, c.sensitivity_taxels * float(skin.areas[0]))
        else:
            task = DirectInteraction(skin)
        task.damping = (c.yield_damping, 0.1 * c.yield_damping)
        levels: list[list[Task]] = [[self.base_task()], [task], [self.posture_task()]]
        return StandingController(self.stance, levels, None, skin, c)

    def act(self, world: World, time: float) -> None:
        for push in self._pushes.values():
            done = time >= min(push.end, push.full + push.window[1])
            push.pad.wanted = self.force if push.begin <= time and not done else 0.0
        super().act(world, time)

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        super().judge(world, sensor, time)
        joints = np.array([world.data.joint(name).qpos[0] for name in _JOINTS])
        for push in self._pushes.values():
            force = self.pressing(push.pad)
            if not np.isfinite(push.full) and force > 0.95 * self.force:
                push.full = time
            if push.full + push.window[0] <= time < push.full + push.window[1]:
                push.taxels.append(float((sensor.force[self._slice] >= 0.15).sum()))
                push.forces.append(force)
                push.times.append(time)
                push.joints.append(joints)
        if self._steps % 10 == 0:
            speed = float(np.linalg.norm([world.data.joint(name).qvel[0] for name in _JOINTS]))
            self._trace.append((time, sum(self.pressing(p.pad) for p in self._pushes.values()), speed))

    def verdict(self) -> Verdict:
        one = self._pushes["one"]
        many = self._pushes["hundred"]
        areas = float(np.mean(many.taxels or [0.0]) / np.mean(one.taxels or [np.nan]))
        forces = float(np.mean(one.forces or [np.nan]) / np.mean(many.forces or [np.nan]))
        ratio = one.speed / many.speed / forces
        off = abs(ratio / areas - 1.0) if areas > 0.0 and np.isfinite(ratio) else 1.0
        limit = self.settings.tolerance
        text = f"speeds differ by {ratio:.1f}, areas by {areas:.1f}; allowed: {limit:.0%} apart"
        reasons = self.balance_reasons() + unmet((off <= limit, "area_law", off, limit, text))
        figures = {
            **self.balance_figures(),
            "speed_ratio": round(ratio, 2) if np.isfinite(ratio) else None,
            "area_ratio": round(areas, 2) if np.isfinite(areas) else None,
            "speeds_rad_s": {
                name: round(p.speed, 5) if np.isfinite(p.speed) else None for name, p in self._pushes.items()
            },
            "forces_N": {name: round(float(np.mean(p.forces or [0.0])), 2) for name, p in self._pushes.items()},
            "taxels": {name: round(float(np.mean(p.taxels or [0.0])), 1) for name, p in self._pushes.items()},
        }
        return Verdict(reasons, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        trace = np.array(self._trace)
        figure, (upper, lower) = new_figure(8.0, 5.0, rows=2, sharex=True)
        upper.plot(trace[:, 0], trace[:, 1], color=COLOURS["truth"])
        upper.set(ylabel="force of the probe [N]")
        lower.semilogy(trace[:, 0], np.maximum(trace[:, 2], 1e-5), color=COLOURS["left"], label="joint speed")
        for name, push in self._pushes.items():
            if len(push.times) > 1:
                window = [push.times[0], push.times[-1]]
                lower.plot(window, [push.speed] * 2, color=COLOURS["right"], linewidth=3)
                lower.annotate(f"{name} ({push.speed:.3g} rad/s)", (window[0], 1.3 * push.speed), fontsize=7)
        lower.set(xlabel="time [s]", ylabel="speed of the waist [rad/s]")
        return [save_figure(figure, folder / "pressure.png")]
