"""A walk ready to run: robot, ground, controller, sensors and judge."""

import os
import time as clock
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from plantar.common.sides import SIDES
from plantar.gait.controller import Command, Start
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.kernels.judging.physics_steps import PhysicsSteps
from plantar.layouts.layout import Side, SoleLayout
from plantar.percepts.percept import Percept
from plantar.robots.kinematics.robot_model import Visitor
from plantar.sensing.link_skin import BodySkin
from plantar.sim.figures.film import Film
from plantar.sim.figures.run_figure import plot_run
from plantar.sim.loop import Progress, Result, Run
from plantar.sim.model.world import World, build_world, check_stable
from plantar.sim.plant.draw import drawn_plant
from plantar.sim.run.judges import Judges
from plantar.sim.run.log import RunLog
from plantar.sim.run.motor_drives import MotorDrives
from plantar.sim.run.planned_walk import planned_feet
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.run_summary import summary_of
from plantar.sim.run.scene import SECTIONS, Push, Scene
from plantar.sim.run.servos import LegServos
from plantar.sim.run.standing import stand
from plantar.sim.run.touched import Touched
from plantar.sim.run.walker import walker_of
from plantar.sim.sensing.sensors import SensorSuite

if TYPE_CHECKING:
    from plantar.sim.arms.compliant_arm import CompliantArm

_MEMBERS = frozenset(Percept.members())


class Simulation(Run):
    """A scene with a robot in it, ready to run.

    Args:
        scene: The scene.
        seed: Of noise and open choices.
        layouts: Instead of the robot's own.

    Raises:
        RobotError: If the robot is invalid.
        SceneError: If the scene is impossible.
    """

    def __init__(self, scene: Scene, seed: int = 0, layouts: Mapping[Side, SoleLayout] | None = None) -> None:
        self.seed = seed
        self.skipped = Counter(percept_members=0, recorded_ticks=0, rendered_frames=0)
        self._log: RunLog | None = None
        self.compile(scene, layouts)
        self.initialize()
        self.reset()

    def compile(self, scene: Scene, layouts: Mapping[Side, SoleLayout] | None) -> None:
        """Make what needs no physics: robot, plan, controller, and the ground under the plan.

        Args:
            scene: The scene.
            layouts: Instead of the robot's own, or None.
        """
        walker = walker_of(scene, self.seed, layouts, self.placed)
        self.walker = walker
        self.scene = walker.scene
        self.robot = walker.robot
        self.worn = walker.worn
        self.legs = walker.legs
        self.body = walker.body
        self.velocities = walker.velocities
        self.feet = walker.feet
        self.steps = walker.steps
        self.settings = walker.settings
        self.motors = walker.motors
        self.controller = walker.controller
        self.centers = walker.controller.middles
        self._everything = self.scene.control.skip == "none"
        self.planned = planned_feet(self.robot, self.feet, self.steps, self.controller.schedule)
        self.ground = self.scene.terrain.ground(self.planned, np.random.default_rng([self.seed, 0x7E]))
        joints = 2 * len(self.robot.legs["left"].joints)
        self.plant = drawn_plant(self.scene.plant, self.seed, self.body, joints, self.robot.layouts)

    def initialize(self) -> None:
        """Make the world, and what moves, touches and measures the robot in it."""
        self.touched = self._upper_body(self.walker.skin)
        worn = () if self.worn is None else (self.worn,)
        partners = () if self.touched is None else self.touched.partners
        self.world: World = self.build_world((*worn, *partners))
        self.periods = self.world.period, self.settings.period
        self.touch = None if self.touched is None else self.touched.enter(self.world)
        self.sensors = self._sensor_suite()
        self.sense_every = self.sensors.skin_every
        self.servos = self._drives()
        force = self.scene.push if self.scene.push.by == "force" else Push()
        self.pusher = Pusher(force, self.controller.schedule, self.seed)
        self.arm = self._moving_arm(self.settings.skin)

    def reset(self) -> None:
        """Stand the robot on its feet at time 0, where judging begins."""
        centers = {side: vrp_of_step(self.feet[side], self.centers[side]) for side in SIDES}
        hold = None if self.arm is None else self.arm.hold
        stand(self.world, self.legs, self.servos, self.feet, centers, self.settings.com_height, hold)
        if self.touch is not None:
            self.touch.place()
            if self.scene.sensing.body_skin:
                self.sensors.body_skin = self.touch.read
        self.judges = Judges(self.walker, self.world, self.ground, self.pusher, self.touched, self.touch)
        self.judge = self.judges.judge
        self._together = self._physics_steps()
        self.foothold_truth = self.judges.footholds
        self.recovery = self.judges.recovery
        self.speeds = self.judges.speeds
        self.zmps = self.judges.zmps

    def _physics_steps(self) -> PhysicsSteps | None:
        """Physics steps in one kernel, while no push acts; None where a partner touches or the ground moves."""
        drives = self.servos.plain
        if drives is None or self.world.moving_ground or self.touch is not None:
            return None
        return self.judge.physics_steps(drives, self._physics_step())

    def _physics_step(self) -> Callable[[], None]:
        """`step_physics`, without a call of Python unless a subclass does more."""
        usual = type(self).step_physics is Simulation.step_physics
        return partial(mujoco.mj_step, self.world.model, self.world.data) if usual else self.step_physics

    def placed(self, start: Start) -> Start:
        """The start of the walk; others may move it."""
        return start

    def build_world(self, others: Sequence[Visitor]) -> World:
        """The run's world, with robot, ground and others."""
        scene = self.scene
        period = scene.control.physics_period
        return build_world(self.robot, self.ground, period, self.plant, others, scene.sole_contact)

    def _upper_body(self, skin: BodySkin | None) -> Touched | None:
        if skin is None:
            return None
        reach = self.scene.terrain.height + self.settings.com_height
        plan = (lambda: self.controller.schedule, self.feet, self.steps)
        return Touched(self.scene, skin, self.body, *plan, self.seed, reach, self.settings.period, self.worn)

    def _sensor_suite(self) -> SensorSuite:
        sensing = self.scene.sensing
        control = self.scene.control
        return SensorSuite(
            self.world,
            sensing,
            self.seed,
            proximity=control.pfc or control.footholds == "skin",
            force_torque=sensing.force_torque or "force_torque" in (control.zmp_source, control.feasibility),
            plant=self.plant,
        )

    def _drives(self) -> LegServos | MotorDrives:
        if self.motors is None:
            return LegServos(self.world, self.legs, self.settings.period, self.plant)
        return MotorDrives(self.world, self.motors, self.plant)

    def _moving_arm(self, skin: BodySkin | None) -> "CompliantArm | None":
        if self.worn is None:
            return None
        from plantar.sim.arms.compliant_arm import CompliantArm  # and whole-body control, a quarter of all imports

        noise = self.scene.sensing.encoder_noise
        arm = CompliantArm(self.worn, skin, self.scene.arm, self.world, self.settings.period, noise, self.seed)
        self.legs.hold_others(arm.posture)
        self.sensors.body_links = arm.read
        return arm

    @property
    def end(self) -> float:
        if self.velocities is None:
            return self.controller.end
        return max(self.controller.end, self.velocities.times[-1] + self.settings.timing.settle)

    @property
    def ended(self) -> bool:
        return self.judge.fall is not None

    def state_text(self) -> str:
        return f"{self.world.data.time:.1f} s, {len(self.judge.landings)} landings for {len(self.steps)} steps"

    def open_log(self, path: Path, files: ExitStack) -> None:
        log = RunLog(path, self.world, self._identity(), zmps=bool(self.judges.zmps), touch=self.touch, arm=self.arm)
        self._log = files.enter_context(log)

    def open_film(self, path: Path, files: ExitStack) -> Callable[[], None]:
        film = files.enter_context(Film(path, self.world))
        return lambda: film.add(self.sensors.readings)

    def summary(self, result: Result) -> dict[str, Any]:
        if self.judge.fall is not None and self._log is not None:
            self._log.note(self.world.data.time, self.judge.fall[2], "error")
        if self.sensors.proximity:
            self.skipped["proximity_rays"] = sum(s.skipped for s in self.sensors.proximity.values())
        return summary_of(self, result)

    def plot(self, folder: Path, recording: Path) -> list[Path]:
        return plot_run(recording, folder)

    def sense(self, k: int) -> None:
        if k % self.sensors.skin_every == 0:
            self.sensors.read_skins(self.controller.proximity_sides, self._everything, self.judge.feet)
            if self._log is not None:
                self._log.skin(self.sensors.readings)

    def control(self) -> float:
        reading = self.sensors.read_body()
        if self.arm is not None:
            self.arm.step(reading.skin)
            self.legs.hold_others(self.arm.angles)
        start = clock.perf_counter()
        command = self.controller.step(reading)
        joints = self.servos.command(command)
        if self.controller.shell is not None:
            self.controller.shell.commanded = joints
        used = 1e6 * (clock.perf_counter() - start)
        self._tick = reading, command, joints
        self.skipped["percept_members"] += self.compute_rest(command, self._everything)
        return used

    def advance(self, steps: int = 1) -> int:
        together = self._together
        if together is not None and self.servos.plain is not None:
            free = self.pusher.free_steps(self.world, steps) if self.pusher.shoves else steps
            if free:
                steps = together.advance(free)
                if together.seen:
                    self.judge.look(together.seen)
                    check_stable(self.world.data.warning.number)
                return steps
        self.servos.drive()
        if self.pusher.shoves:
            self.pusher.apply(self.world)
        if self.world.moving_ground:
            self.world.move_ground()
        self.step_physics()
        if self.judge.step():
            check_stable(self.world.data.warning.number)
        return 1

    def step_physics(self) -> None:
        """One physics step with present set-points and pushes."""
        if self.touch is None:
            mujoco.mj_step(self.world.model, self.world.data)
        else:
            self.touch.step()

    def after_tick(self) -> None:
        reading, command, joints = self._tick
        self.judges.update(reading, command)
        if self._log is None:
            self.skipped["recorded_ticks"] += 1
            return
        judge = self.judge
        self._log.tick(reading, command, self.controller.plan.view, joints, judge.truth(), judge.loads)
        if self.judges.zmps is not None:
            self._log.zmps(reading.time, *self.judges.zmps.latest)

    def compute_rest(self, command: Command, everything: bool) -> int:
        """Returns how many percepts of a `command` were not computed; `everything` computes them all."""
        if everything:
            for percept in command.percepts.values():
                for name in _MEMBERS:
                    getattr(percept, name)
            return 0
        percepts = command.percepts
        # A percept keeps its members alone.
        return 2 * len(_MEMBERS) - len(percepts["left"].__dict__) - len(percepts["right"].__dict__)

    def _identity(self) -> dict[str, object]:
        return {
            "scene": self.scene.name,
            "robot": self.robot.name,
            "seed": self.seed,
            "mass_kg": self.legs.mass,
            "ground": self.ground.seen_from_above(),
            "settings": {name: asdict(getattr(self.scene, name)) for name in SECTIONS},
        }


def run_scene(
    scene: Scene,
    seed: int = 0,
    *,
    layouts: Mapping[Side, SoleLayout] | None = None,
    record: str | os.PathLike[str] | None = None,
    video: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Returns the summary (`Simulation.run`) of a `scene` with a `seed`, and `layouts` in place of the robot's.

    `record` and `video` are files or None; `progress` gets fraction and text.
    """
    return Simulation(scene, seed, layouts).run(record=record, video=video, progress=progress)
