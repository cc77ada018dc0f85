"""A hand, then an object without mass, come near the robot's hand, which is repelled and never touched (T 3.3.1.1)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import mujoco
import numpy as np

from plantar.common.settings.schema import Settings, number, switch
from plantar.mujoco.foam_skins import FoamSkins
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sim.companion.experiment import Controller, Verdict, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.controller import StandingControl, StandingController
from plantar.sim.companion.standing.standing import StandingExperiment
from plantar.sim.companion.standing.visitor import Visitor
from plantar.wholebody.tasks.skin_interaction import DirectInteraction, ProximityInteraction
from plantar.wholebody.tasks.task import Task

_LOOK_EVERY = 5  # physics steps between two looks at the distance
_FARTHEST = 0.2  # m: beyond it no distance is looked for


class FeatherSettings(Settings):
    """How visitors come.

    Attributes:
        speed: Mean speed; each seed has its own.
        moved: Least way of the repelled hand.
    """

    speed: float = number(0.05, "m/s", 0.001, 1.0)
    beyond: ClassVar[float] = 0.06  # How far they go beyond the hand's first place
    moved: float = number(0.04, "m", 0.0, 0.5)
    early: ClassVar[float] = 0.005  # Largest way of the hand before a visitor is in range


class FeatherControl(StandingControl):
    """How the machine is repelled.

    Attributes:
        proximity: Whether nearness repels it.
        range: Distance from which it does.
        stiffness: Virtual force of one taxel per metre of used range.
    """

    proximity: bool = switch(True)
    range: float = number(0.02, "m", 0.001, 0.05)
    stiffness: float = number(300.0, "N/m", 0.0, 1e5)
    repelled_damping: ClassVar[float] = 40.0  # N s/m: damping of a repelled link


class Feather(StandingExperiment):
    """Two visitors of a hand, each towards a random taxel of palm or back."""

    settings_type: ClassVar = FeatherSettings
    control_type: ClassVar = FeatherControl
    claims: ClassVar = {
        **StandingExperiment.claims,
        "touched": "the hand is never touched",
        "repelled": "each visitor repels it",
        "early": "it stays while nothing is near",
    }
    columns: ClassVar = ("distance_min_mm", "moved_mm", "cop_margin_min_mm")

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        box = mujoco.mjtGeom.mjGEOM_BOX
        sphere = mujoco.mjtGeom.mjGEOM_SPHERE
        self.visitors = [
            Visitor("visiting hand", box, (0.03, 0.045, 0.015), 0.015),
            Visitor("feather", sphere, (0.015, 0.0, 0.0), 0.015),
        ]
        self.side = str(self.rng.choice(["left", "right"]))
        end = 0.5
        for visitor in self.visitors:
            patch = self.skin.patch(f"{self.side}_hand_{self.rng.choice(['palm', 'back'])}")
            taxel = int(self.rng.choice(patch.from_middle[:4]))
            origin, rotation = self.robot.pose(patch.link)
            way = rotation @ patch.rotations[taxel, :, 2] + self.rng.normal(0.0, 0.06, 3)
            speed = settings.speed * self.rng.uniform(0.6, 1.4)
            target = origin + rotation @ patch.positions[taxel]
            end = visitor.plan(target, way, end, speed, 0.06, settings.beyond) + 1.0
        self.duration = end
        self._link = f"{self.side}_hand"
        self._rest = self.robot.pose(self._link)[0]
        self._closest = {v.name: _FARTHEST for v in self.visitors}
        self._moved = {v.name: 0.0 for v in self.visitors}
        self._early = 0.0
        self._measured = 0.0
        self._trace: list[tuple[float, float, float]] = []

    def add_to(self, spec: Any) -> None:
        super().add_to(spec)
        for visitor in self.visitors:
            visitor.add_to(spec)

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        c = self.control
        near = ProximityInteraction(skin, c.stiffness, c.range)
        near.damping = (c.repelled_damping, 0.02 * c.repelled_damping)
        touch = DirectInteraction(skin, c.gain)
        reacting: list[Task] = [touch, near] if c.proximity else [touch]
        apart: list[Task] = [self.self_collision_task(), self.joint_range_task()]
        levels: list[list[Task]] = [self.balance_tasks(), apart, reacting, [self.posture_task()]]
        return StandingController(self.stance, levels, self.balance, skin, c)

    def act(self, world: World, time: float) -> None:
        for visitor in self.visitors:
            visitor.act(world, time)
        super().act(world, time)

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        super().judge(world, sensor, time)
        self._measured = max(self._measured, float(sensor.force.max()))
        if self._steps % _LOOK_EVERY:
            return
        hand = int(world.model.body(self._link).geomadr[0])
        moved = float(np.linalg.norm(world.pose(self._link)[0] - self._rest))
        nearest = _FARTHEST
        for visitor in self.visitors:
            geom = world.model.geom(visitor.name).id
            apart = float(mujoco.mj_geomDistance(world.model, world.data, hand, geom, _FARTHEST, None))
            nearest = min(nearest, apart)
            self._closest[visitor.name] = min(self._closest[visitor.name], apart)
            if apart < 1.5 * self.control.range:
                self._moved[visitor.name] = max(self._moved[visitor.name], moved)
            elif min(self._closest.values()) >= 1.5 * self.control.range:
                self._early = max(self._early, moved)
        self._trace.append((time, nearest, moved))

    def verdict(self) -> Verdict:
        closest = min(self._closest.values())
        s = self.settings
        touch = f"the hand was touched: nearest distance {1e3 * closest:.1f} mm, force {self._measured:.2f} N"
        early = f"the hand moved by {1e3 * self._early:.1f} mm before anything was near"
        repelled = "{} repelled the hand by {:.0f} mm; wanted: {:.0f}"
        reasons = self.balance_reasons() + unmet(
            (closest > 0.0 >= self._measured, "touched", closest, 0.0, touch),
            *(
                (moved >= s.moved, "repelled", moved, s.moved, repelled.format(name, 1e3 * moved, 1e3 * s.moved))
                for name, moved in self._moved.items()
            ),
            (self._early <= s.early, "early", self._early, s.early, early),
        )
        figures = {
            **self.balance_figures(),
            "distance_min_mm": round(1e3 * closest, 2),
            "distances_min_mm": {name: round(1e3 * d, 2) for name, d in self._closest.items()},
            "moved_mm": round(1e3 * min(self._moved.values()), 1),
            "force_max_N": round(self._measured, 3),
        }
        return Verdict(reasons, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        time, near, moved = np.array(self._trace).T
        figure, (upper, lower) = new_figure(8.0, 5.0, rows=2, sharex=True)
        upper.plot(time, 1e3 * near, color=COLOURS["truth"])
        upper.axhline(1e3 * self.control.range, color=COLOURS["reference"], linestyle="--", label="used range")
        upper.set(ylabel="visitor to hand [mm]", ylim=(0.0, 80.0))
        upper.legend()
        lower.plot(time, 1e3 * moved, color=COLOURS["left"])
        lower.set(xlabel="time [s]", ylabel="hand moved [mm]")
        return [save_figure(figure, folder / "feather.png")]
