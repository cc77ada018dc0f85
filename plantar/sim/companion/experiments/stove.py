"""A hand over a hot plate draws back when its skin gets warm (T 3.3.2.1).

Cool skin: support, hand, posture. Warm skin: support, heat with posture; with `keep_hand`, as in T, support, heat,
hand, posture.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import mujoco
import numpy as np

from plantar.common.settings.schema import number, switch
from plantar.mujoco.foam_skins import FoamSkins
from plantar.plotting import COLOURS, new_figure, save_figure
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.surface import OBSTACLE_GROUP
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import Controller, Verdict, World, unmet
from plantar.sim.companion.machine import Machine
from plantar.sim.companion.standing.controller import StandingControl, StandingController
from plantar.sim.companion.standing.heat import HotPlate, PlateSettings
from plantar.sim.companion.standing.standing import StandingExperiment
from plantar.wholebody.fusion.priority_transition import PriorityTransition
from plantar.wholebody.tasks.cartesian_pose import CartesianPose, PoseGains
from plantar.wholebody.tasks.skin_interaction import TemperatureInteraction
from plantar.wholebody.tasks.task import Task

_LINK = "right_hand"
_PATCHES = ("right_hand_palm", "right_hand_back")
_WARM_EVERY = 10  # physics steps
# s: when the hand sets out for the plate, and how long it takes
_BEGIN = 1.0
_WAY = 2.0
_CIRCLE = 4.0  # s


class StoveSettings(PlateSettings):
    """Plate and limits.

    Attributes:
        limit: Temperature that no taxel may reach.
        height: Mean working height of the palm over the plate; each seed has its own.
        duration: Simulated time.
    """

    limit: float = number(45.0, "degC", 0.0, 1000.0)
    height: float = number(0.07, "m", 0.02, 0.5)
    retreat: ClassVar[float] = 0.04  # How far above its work the hand has to draw back, in m
    duration: float = number(20.0, "s", 1.0, 1000.0)


class StoveControl(StandingControl):
    """Reaction to heat.

    Attributes:
        temperature: Whether heat repels the machine.
        threshold: kappa_0 of T 3.34: temperature from which it does.
        keep_hand: Whether the hand's task goes on below heat.
    """

    temperature: bool = switch(True)
    keep_hand: bool = switch(False)
    threshold: float = number(31.0, "degC", -50.0, 1000.0)
    repulsion: ClassVar[float] = 2.0  # N/K: force of one taxel a kelvin above the threshold
    repelled_damping: ClassVar[float] = 80.0  # N s/m: damping of the hand while it is repelled


class Stove(StandingExperiment):
    """The right palm circles over the plate at random height and radius."""

    settings_type: ClassVar = StoveSettings
    control_type: ClassVar = StoveControl
    claims: ClassVar = {
        **StandingExperiment.claims,
        "arrived": "the hand comes to its work over the plate",
        "temperature": "no taxel gets too hot",
        "retreat": "the hand draws back",
    }
    columns: ClassVar = ("temperature_max", "retreat_mm", "cop_margin_min_mm")
    posture: ClassVar = {"right_wrist_yaw": -90.0, "right_shoulder_pitch": 20.0, "right_elbow": 70.0}

    def __init__(self, machine: Machine, settings: Any, control: Any, seed: int) -> None:
        super().__init__(machine, settings, control, seed)
        self.duration = settings.duration
        skin = self.skin
        self._taxels = np.concatenate([np.arange(len(skin))[skin.slices[name]] for name in _PATCHES])
        self._points = skin.positions[self._taxels]
        self._normals = skin.normals[self._taxels]
        self._palm = skin.positions[skin.slices["right_hand_palm"]].mean(0)
        place = self.robot.place(_LINK, self._palm)
        self.height = settings.height * self.rng.uniform(0.8, 1.2)
        self._radius = self.rng.uniform(0.0, 0.04)
        self._phase = self.rng.uniform(0.0, 2.0 * math.pi)
        away = np.array([0.10, -0.16, 0.0]) * self.rng.uniform(0.8, 1.0)
        self.middle = place + away - [0.0, 0.0, self.height]
        self.plate = HotPlate(self.middle, settings, len(self._taxels))
        self._warmth = np.full(len(skin), settings.room)
        self._start = place
        self._hottest = settings.room
        self._retreat = 0.0
        self._arrived = False
        self._silent = True
        self._trace: list[tuple[float, ...]] = []
        self._hand = CartesianPose(_LINK, self._palm, PoseGains(speed=0.2))
        self._transition = PriorityTransition()
        self._control: StandingController

    def add_to(self, spec: Any) -> None:
        super().add_to(spec)
        body = spec.worldbody.add_body(name="plate", pos=(self.middle - [0.0, 0.0, 0.01]).tolist())
        body.add_geom(
            name="plate",
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[self.settings.radius, 0.01, 0.0],
            group=OBSTACLE_GROUP,
            rgba=[0.5, 0.1, 0.05, 1.0],
        )

    def controller(self, machine: Machine, skin: BodySkin) -> Controller:
        c = self.control
        self._heat = TemperatureInteraction(skin, c.repulsion, c.threshold, _PATCHES)
        self._heat.damping = (c.repelled_damping, 0.02 * c.repelled_damping)
        base = self.balance_tasks()
        posture = self.posture_task()
        self._working: list[list[Task]] = [base, [self._hand], [posture]]
        self._shunning: list[list[Task]] = (
            [base, [self._heat], [self._hand], [posture]] if c.keep_hand else [base, [self._heat, posture]]
        )
        self._control = StandingController(self.stance, self._working, self.balance, skin, c, self._before)
        self._control.after = self._transition.blend
        return self._control

    def _before(self, robot: MujocoDynamics, measured: Reading) -> None:
        self._hand.target_position = self._target(robot.time)
        silent = not self.control.temperature or not self._heat.wrenches(measured)
        if silent != self._silent:
            self._transition.begin(robot.time)
            self._control.stack.levels = self._working if silent else self._shunning
        self._silent = silent

    def _target(self, time: float) -> Any:
        # Wanted place (3,) of the palm.
        share = min(1.0, max(0.0, (time - _BEGIN) / _WAY))
        angle = self._phase + 2.0 * math.pi * time / _CIRCLE
        circle = np.array([self._radius * math.cos(angle), self._radius * math.sin(angle), self.height])
        return (1.0 - share) * self._start + share * (self.middle + circle)

    def judge(self, world: World, sensor: FoamSkins, time: float) -> None:
        super().judge(world, sensor, time)
        self.temperature = self._warmth
        if self._steps % _WARM_EVERY:
            return
        origin, rotation = world.pose(_LINK)
        period = _WARM_EVERY * world.model.opt.timestep
        warmth = self.plate.step(self._points @ rotation.T + origin, -self._normals @ rotation.T, period)
        self._warmth[self._taxels] = warmth
        hottest = float(warmth.max())
        self._hottest = max(self._hottest, hottest)
        palm = origin + rotation @ self._palm
        work = float(np.linalg.norm(palm - self._target(time)))
        self._arrived = self._arrived or (time > _BEGIN + _WAY and work < 0.02)
        if self._arrived:
            self._retreat = max(self._retreat, work)
        self._trace.append((time, hottest, float(warmth.mean()), 1e3 * float(palm[2] - self.middle[2])))

    def verdict(self) -> Verdict:
        s = self.settings
        hot = f"a taxel reached {self._hottest:.1f} degC; allowed: below {s.limit:g}"
        retreat = f"the hand drew back by {1e3 * self._retreat:.0f} mm; wanted: {1e3 * s.retreat:.0f}"
        reasons = self.balance_reasons() + unmet(
            (self._arrived, "arrived", 0.0, 1.0, "the hand never came to its work over the plate"),
            (self._hottest < s.limit, "temperature", self._hottest, s.limit, hot),
            (self._retreat >= s.retreat, "retreat", self._retreat, s.retreat, retreat),
        )
        figures = {
            **self.balance_figures(),
            "temperature_max": round(self._hottest, 2),
            "retreat_mm": round(1e3 * self._retreat, 1),
        }
        return Verdict(reasons, figures)

    def plot(self, folder: Path) -> Sequence[Path]:
        time, hottest, mean, height = np.array(self._trace).T
        figure, (upper, lower) = new_figure(8.0, 5.0, rows=2, sharex=True)
        upper.plot(time, hottest, color=COLOURS["right"], label="hottest taxel")
        upper.plot(time, mean, color=COLOURS["left"], label="mean of the hand")
        upper.axhline(self.control.threshold, color=COLOURS["reference"], linestyle="--", label="threshold")
        upper.set(ylabel="temperature [degC]")
        upper.legend()
        lower.plot(time, height, color=COLOURS["truth"])
        lower.set(xlabel="time [s]", ylabel="palm above the plate [mm]")
        return [save_figure(figure, folder / "stove.png")]
