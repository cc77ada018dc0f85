"""A walk ready to run: robot, ground, controller, sensors and judge."""

import os
import time as clock
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.common.sides import SIDES
from plantar.errors import SceneError
from plantar.gait.controller import Command, Sensors, Start, WalkingController
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.layouts.layout import Side, SoleLayout
from plantar.percepts.percept import Percept
from plantar.robots.controller_settings import com_height_of, controller_settings
from plantar.robots.kinematics.ankle_limits import ankle_limits
from plantar.robots.kinematics.ankle_sensors import ankle_sensors
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.leg_inertia import leg_inertia
from plantar.robots.kinematics.robot_model import Visitor, build_leg_model
from plantar.robots.motors.torque_control import command_motors
from plantar.robots.robot import Robot
from plantar.robots.robot_file import load_robot
from plantar.robots.start import start_of_walk
from plantar.robots.walk import crouches
from plantar.sensing.link_skin import BodySkin
from plantar.sim.arms.compliant_arm import CompliantArm
from plantar.sim.arms.settings import ArmSettings
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.figures.film import Film
from plantar.sim.figures.run_figure import plot_run
from plantar.sim.judging.foothold_truth import FootholdTruth
from plantar.sim.judging.judge import Judge, PlainGround
from plantar.sim.judging.recovery import Recovery
from plantar.sim.judging.velocity_truth import VelocityTruth
from plantar.sim.judging.walk_goal import WalkGoal
from plantar.sim.judging.zmp_comparison import ZmpComparison
from plantar.sim.loop import Progress, Result, Run
from plantar.sim.model.world import World, build_world, check_stable
from plantar.sim.plant.draw import drawn_plant
from plantar.sim.run.hand_pushing import upper_body_skin_of
from plantar.sim.run.log import RunLog
from plantar.sim.run.motor_drives import MotorDrives
from plantar.sim.run.planned_walk import planned_feet
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.run_summary import summary_of
from plantar.sim.run.scene import SECTIONS, Push, Scene
from plantar.sim.run.servos import LegServos
from plantar.sim.run.standing import stand
from plantar.sim.run.touched import Touched
from plantar.sim.sensing.sensors import SensorSuite

_MEMBERS = frozenset(Percept.members())
_AROUND = 0.25  # leg around a sole within which an edge may be why a step is moved


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
        robot = load_robot(scene.robot)
        if layouts is not None:
            robot = replace(robot, layouts=dict(layouts))
        self.robot: Robot = robot
        self.worn = _worn(robot, scene.arm)
        worn = () if self.worn is None else (self.worn,)
        self.legs = build_leg_model(robot, worn)
        self.body = body_of(robot, self.legs.model)
        scene = scene.for_body(self.body)
        self.scene = scene
        walk = scene.walk
        self.velocities = walk.velocities(seed)
        start = self.start_walk()
        self.feet = dict(start.feet)
        self.steps = start.steps
        skin = upper_body_skin_of(scene, robot, self.legs.model, self.body, self.worn)
        self.settings = controller_settings(
            scene,
            robot,
            self.body,
            ankle_sensors(self.legs.model, robot),
            ankle_limits(robot, self.legs.model, self.body.weight, crouches(walk, robot)[1]),
            skin if scene.sensing.body_skin else None,
            leg_inertia(robot, self.legs, com_height_of(walk, robot)),
        )
        self.motors = command_motors(robot, self.legs, self.body, scene.control, self.settings.period)
        self.controller = WalkingController(self.settings, start, robot.layouts, self.legs, self.motors)
        self.centers = self.controller.middles
        self.planned = planned_feet(robot, self.feet, self.steps, self.controller.schedule)
        ground = scene.terrain.ground(self.planned, np.random.default_rng([seed, 0x7E]))
        self.ground = ground
        self.plant = drawn_plant(scene.plant, seed, self.body, len(robot.legs["left"].joints) * 2, robot.layouts)
        self.skipped = Counter(percept_members=0, recorded_ticks=0, rendered_frames=0)
        self._everything = scene.control.skip == "none"
        self._log: RunLog | None = None
        self._enter_world(skin)
        self.periods = self.world.period, self.settings.period
        self._add_judges()

    def _enter_world(self, skin: BodySkin | None) -> None:
        scene = self.scene
        seed = self.seed
        worn = () if self.worn is None else (self.worn,)
        self.touched: Touched | None = None
        if skin is not None:
            reach = scene.terrain.height + self.settings.com_height
            plan = (lambda: self.controller.schedule, self.feet, self.steps)
            self.touched = Touched(scene, skin, self.body, *plan, seed, reach, self.worn)
        others = (*worn, *([] if self.touched is None else self.touched.partners))
        self.world: World = self.build_world(others)
        self.touch = None if self.touched is None else self.touched.enter(self.world)
        self.sensors = SensorSuite(
            self.world,
            scene.sensing,
            seed,
            proximity=scene.control.pfc or scene.control.footholds == "skin",
            force_torque=scene.sensing.force_torque
            or "force_torque" in (scene.control.zmp_source, scene.control.feasibility),
            plant=self.plant,
        )
        self.servos: LegServos | MotorDrives
        if self.motors is None:
            self.servos = LegServos(self.world, self.legs, self.settings.period, self.plant)
        else:
            self.servos = MotorDrives(self.world, self.motors, self.plant)
        force = scene.push if scene.push.by == "force" else Push()
        self.pusher = Pusher(force, self.controller.schedule, seed)
        centers = {side: vrp_of_step(self.feet[side], self.centers[side]) for side in SIDES}
        self.arm = self._arm(self.settings.skin)
        hold = None if self.arm is None else self.arm.hold
        stand(self.world, self.legs, self.servos, self.feet, centers, self.settings.com_height, hold)
        if self.touch is not None:
            self.touch.place()
            if scene.sensing.body_skin:
                self.sensors.body_skin = self.touch.read

    def _add_judges(self) -> None:
        scene = self.scene
        robot = self.robot
        ground = self.ground
        self.recovery = Recovery(self.pusher.shoves, self.body) if scene.push.count else None
        self.zmps: ZmpComparison | None = None
        if scene.sensing.force_torque:
            self.zmps = ZmpComparison(robot.layouts, scene.sensing.force_noise, self.settings.period)
        self.foothold_truth = FootholdTruth(self.world, ground)
        goal = WalkGoal(self.feet, self.steps, self.body.leg, scene.guide.way)
        self.speeds: VelocityTruth | None = None
        if self.velocities is not None:
            begin = goal.end(self.centers)
            self.speeds = VelocityTruth(self.world, self.velocities, self.settings.timing, begin)
        plain = PlainGround(ground, {s: robot.layouts[s].outline for s in SIDES}, _AROUND * self.body.leg)
        self.judge = Judge(
            self.world,
            self.settings.com_height,
            goal,
            plain,
            scene.control.learn_strides,
            actors=(self.pusher,) if self.touch is None else (self.pusher, self.touch.sensor),
        )
        if any(criterion.of_pieces for criterion in scene.outcome.values()):
            self.judge.follow_pieces(ground)

    def build_world(self, others: Sequence[Visitor]) -> World:
        """The run's world, with robot, ground and others."""
        scene = self.scene
        period = scene.control.physics_period
        return build_world(self.robot, self.ground, period, self.plant, others, scene.sole_contact)

    def _arm(self, skin: BodySkin | None) -> CompliantArm | None:
        if self.worn is None:
            return None
        noise = self.scene.sensing.encoder_noise
        period = self.settings.period
        arm = CompliantArm(self.worn, skin, self.scene.arm, self.world, period, noise, self.seed)
        self.legs.hold_others(arm.posture)
        self.sensors.body_links = arm.read
        return arm

    def start_walk(self) -> Start:
        """Feet at the start, and planned and commanded walk; raises SceneError if the robot cannot walk so."""
        scene = self.scene
        height = com_height_of(self.scene.walk, self.robot)
        try:
            return start_of_walk(scene.walk, self.robot, height, scene.terrain.height, self.velocities)
        except SceneError as error:
            raise SceneError(f"scene '{scene.name}': {error}") from None

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
        log = RunLog(path, self.world, self._identity(), zmps=bool(self.zmps), touch=self.touch, arm=self.arm)
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
            self.sensors.read_skins(self.controller.proximity_sides, self._everything)
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
        used = 1e6 * (clock.perf_counter() - start)
        self._tick = reading, command, joints
        self.skipped["percept_members"] += self.compute_rest(command, self._everything)
        return used

    def advance(self) -> None:
        self.servos.drive()
        if self.pusher.shoves:
            self.pusher.apply(self.world)
        if self.world.moving_ground:
            self.world.move_ground()
        self.step_physics()
        if self.judge.step():
            check_stable(self.world.data.warning.number)

    def step_physics(self) -> None:
        """One physics step with present set-points and pushes."""
        if self.touch is None:
            mujoco.mj_step(self.world.model, self.world.data)
        else:
            self.touch.step()

    def after_tick(self) -> None:
        reading, command, joints = self._tick
        self._judge_tick(reading, command)
        if self._log is None:
            self.skipped["recorded_ticks"] += 1
            return
        judge = self.judge
        self._log.tick(reading, command, self.controller.plan.view, joints, judge.truth(), judge.loads)
        if self.zmps is not None:
            self._log.zmps(reading.time, *self.zmps.latest)

    def _judge_tick(self, reading: Sensors, command: Command) -> None:
        judge = self.judge
        time = reading.time
        if command.footholds:
            self.foothold_truth.update(command.footholds)
        pushed = self.pusher.pushing or (self.touch is not None and bool(np.any(self.touch.force)))
        judge.update(time, command.state.com, command.state.zmp, command.moved_steps, pushed)
        if self.speeds is not None:
            self.speeds.update(time)
        if self.touched is not None:
            self.touched.update(self.world, time, judge.truth().zmp)
        if self.zmps is not None:
            self.zmps.update(time, command)
        if self.recovery is not None:
            plan = command.reference
            com = self.world.data.subtree_com[self.world.torso, :2]
            self.recovery.update(time, judge.truth().zmp, com, plan.vrp, plan.com)

    def compute_rest(self, command: Command, everything: bool) -> int:
        """Returns how many percepts of a `command` were not computed; `everything` computes them all."""
        count = 0
        for percept in command.percepts.values():
            if everything:
                for name in _MEMBERS:
                    getattr(percept, name)
            else:
                count += len(_MEMBERS) - len(_MEMBERS.intersection(percept.__dict__))
        return count

    def _identity(self) -> dict[str, object]:
        return {
            "scene": self.scene.name,
            "robot": self.robot.name,
            "seed": self.seed,
            "mass_kg": self.legs.mass,
            "ground": self.ground.seen_from_above(),
            "settings": {name: asdict(getattr(self.scene, name)) for name in SECTIONS},
        }


def _worn(robot: Robot, arm: ArmSettings) -> WornArm | None:
    if arm.side == "none":
        return None
    return WornArm(robot, "left" if arm.side == "left" else "right", arm.posture)


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
