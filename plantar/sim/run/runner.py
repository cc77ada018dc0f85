"""Run one scenario: physics, skin, control and judge in one loop."""

from __future__ import annotations

import math
import os
import time as clock
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from plantar.errors import InputError, SceneError
from plantar.gait.contact.foot_contacts import middle_of_sole
from plantar.gait.controller import Command, Start, WalkingController
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.gait.propose.velocity_command import Legs, VelocityCommand
from plantar.layouts.layout import Side, SoleLayout
from plantar.percepts.percept import Percept
from plantar.sensing.link_skin import BodySkin
from plantar.sides import SIDES
from plantar.sim.arms.compliant_arm import CompliantArm
from plantar.sim.arms.settings import ArmSettings
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.figures.film import Film
from plantar.sim.figures.render import FRAME_RATE
from plantar.sim.judging.foothold_truth import FootholdTruth
from plantar.sim.judging.judge import Judge
from plantar.sim.judging.recovery import Recovery
from plantar.sim.judging.velocity_truth import VelocityTruth
from plantar.sim.judging.verdict import Ending, reasons
from plantar.sim.judging.walk_goal import WalkGoal
from plantar.sim.judging.zmp_comparison import ZmpComparison
from plantar.sim.model.ankle_limits import ankle_limits
from plantar.sim.model.body import body_of
from plantar.sim.model.world import Visitor, World, build_leg_model, build_world, check_stable
from plantar.sim.plant.draw import drawn_plant
from plantar.sim.robots.robot import Robot
from plantar.sim.robots.robot_file import load_robot
from plantar.sim.run.box_plan import box_plan
from plantar.sim.run.controller_settings import controller_settings
from plantar.sim.run.hand_pushing import upper_body_skin_of
from plantar.sim.run.log import RunLog
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.scene import SECTIONS, Push, Scene
from plantar.sim.run.servos import LegServos
from plantar.sim.run.shares import body_told, shares_told
from plantar.sim.run.standing import stand
from plantar.sim.run.touched import Touched
from plantar.sim.sensing.sensors import SensorSuite, ankle_sensors
from plantar.sim.terrain import Footprint, PlannedFeet

__all__ = ["Simulation", "run_scene"]

Progress = Callable[[float, str], None]

_MEMBERS = frozenset(Percept.members())
_LONGEST = 5  # times its first duration, after which a run whose end is put off again and again is cut off


@dataclass(frozen=True)
class _Result:
    """What a run leaves behind for its summary."""

    ticks_us: list[float]
    wall_time: float
    skipped: dict[str, int]
    overrun: tuple[float, float] | None


class Simulation:
    """A scene with a robot in it, ready to run.

    Args:
        scene: The scene.
        seed: Seed of sensor noise and of what the scene leaves to chance.
        layouts: Sole layouts to wear instead of the robot's own, for example from a freshly built shoe.

    Raises:
        RobotError: If the robot is unknown or not valid.
        SceneError: If the robot cannot do what the scene asks for.
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
        self.scene = scene = scene.for_body(self.body)
        walk = scene.walk
        self.velocities = walk.velocities(seed)
        self.feet, self.steps = self._plan()
        skin = upper_body_skin_of(scene, robot, self.legs.model, self.body, self.worn)
        self.settings = controller_settings(
            scene,
            robot,
            self.body,
            ankle_sensors(self.legs.model, robot),
            ankle_limits(robot, self.legs.model, self.body.weight),
            skin if scene.sensing.body_skin else None,
        )
        start = Start(self.feet, self.steps, walk.begin, self._commands())
        self.controller = WalkingController(self.settings, start, robot.layouts, self.legs)
        ground = scene.terrain.ground(self._planned_feet(), np.random.default_rng([seed, 0x7E]))
        self.ground = ground
        self.plant = drawn_plant(scene.plant, seed, self.body, len(robot.legs["left"].joints) * 2, robot.layouts)
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
        self.servos = LegServos(self.world, self.legs, self.settings.period, self.plant)
        force = scene.push if scene.push.by == "force" else Push()
        self.pusher = Pusher(force, self.controller.schedule, seed)
        self.recovery = Recovery(self.pusher.shoves, self.controller.end, self.body) if scene.push.count else None
        self.zmps: ZmpComparison | None = None
        if scene.sensing.force_torque:
            self.zmps = ZmpComparison(robot.layouts, scene.sensing.force_noise, self.settings.period)
        centers = {}
        for side in SIDES:
            centers[side] = vrp_of_step(self.feet[side], middle_of_sole(robot.layouts[side], robot.ankle_reach))
        self.arm = self._arm(self.settings.skin)
        hold = None if self.arm is None else self.arm.hold
        stand(self.world, self.legs, self.servos, self.feet, centers, self.settings.com_height, hold)
        if self.touch is not None:
            self.touch.place()
            if scene.sensing.body_skin:
                self.sensors.body_skin = self.touch.read
        self.foothold_truth = FootholdTruth(self.world, ground)
        self._centers = {side: middle_of_sole(robot.layouts[side], robot.ankle_reach) for side in SIDES}
        self.speeds: VelocityTruth | None = None
        if self.velocities is not None:
            self.speeds = VelocityTruth(self.world, self.velocities, self.settings.timing)
        goal = WalkGoal(self.feet, self.steps, self.body.leg, scene.guide.way)
        self.judge = Judge(self.world, self.settings.com_height, goal)

    def build_world(self, others: Sequence[Visitor]) -> World:
        """The world of this run, with the robot, its ground and who else is in it.

        Args:
            others: Who else is in it.
        """
        return build_world(self.robot, self.ground, self.scene.control.physics_period, self.plant, others)

    def _arm(self, skin: BodySkin | None) -> CompliantArm | None:
        """The arm that moves, with its sensors; None for a robot without."""
        if self.worn is None:
            return None
        noise, period = self.scene.sensing.encoder_noise, self.settings.period
        arm = CompliantArm(self.worn, skin, self.scene.arm, self.world, period, noise, self.seed)
        self.legs.hold_others(arm.posture)
        self.sensors.body_links = arm.read
        return arm

    def _plan(self) -> tuple[dict[Side, Footstep], tuple[Footstep, ...]]:
        """Where the feet stand, and the footsteps that are planned at the start."""
        walk = self.scene.walk
        steps = walk.steps if self.velocities is None else 0
        width, height = self._stance_width, self.scene.terrain.height
        first: Side = "left" if walk.first == "left" else "right"
        if walk.pattern == "box":
            try:
                return box_plan(steps, stride=walk.length, width=width, first=first, height=height)
            except InputError as error:
                raise SceneError(f"scene '{self.scene.name}': [walk] {error}") from None
        return straight_plan(steps, length=walk.length, sideways=walk.sideways, width=width, first=first, height=height)

    @property
    def _stance_width(self) -> float:
        """Distance in m of the ankles when the feet stand side by side."""
        walk = self.scene.walk
        return (walk.stance_width or self.robot.stance_width) + walk.wider

    def _commands(self) -> tuple[VelocityCommand, ...]:
        """Who commands the walk while it is walked."""
        if self.velocities is None:
            return ()
        width = self._stance_width
        outline = self.robot.layouts["left"].outline
        (rear, inner), toe = (-outline.min(axis=0)).tolist(), float(outline[:, 0].max())
        return (VelocityCommand(self.velocities, Legs(width, self.settings.com_height, rear, toe, inner)),)

    @property
    def end(self) -> float:
        """Time in s at which the run is over: the walk has ended, and nothing is commanded any more."""
        if self.velocities is None:
            return self.controller.end
        return max(self.controller.end, self.velocities.times[-1] + self.settings.timing.settle)

    def _planned_feet(self) -> PlannedFeet:
        """The plan's footprints with their times, which the ground is laid out by."""
        swings = {p.step: p for p in self.controller.schedule.phases if p.swing is not None}

        def footprint(foot: Footstep, step: int | None) -> Footprint:
            center, half = self.robot.sole_rectangle(foot.side)
            place = vrp_of_step(foot, center)
            if step is None:
                return Footprint(foot.side, place, foot.yaw, half, foot.position[:2])
            swing = swings[step]
            return Footprint(foot.side, place, foot.yaw, half, foot.position[:2], swing.start, swing.end)

        return PlannedFeet(
            {side: footprint(self.feet[side], None) for side in SIDES},
            tuple(footprint(foot, k) for k, foot in enumerate(self.steps)),
        )

    def run(
        self,
        *,
        record: str | os.PathLike[str] | None = None,
        video: str | os.PathLike[str] | None = None,
        progress: Progress | None = None,
    ) -> dict[str, Any]:
        """Run the scene to its end or to the fall.

        Args:
            record: MCAP file to write; a run that is killed leaves what it had flushed.
            video: MP4 file to write, in real time.
            progress: Called about ten times a second with the fraction done and a text.

        Returns:
            The summary (see DESIGN: `plantar sim --json`).

        Raises:
            SceneError: If the simulated physics becomes unstable.
        """
        with ExitStack() as stack:
            log = film = None
            if record is not None:
                told, touch = self._identity(), self.touch
                log = stack.enter_context(
                    RunLog(Path(record), self.world, told, zmps=bool(self.zmps), touch=touch, arm=self.arm)
                )
            if video is not None:
                film = stack.enter_context(Film(video, self.world))
            result = self._loop(log, film, progress)
        return self._summary(result)

    def step_physics(self) -> None:
        """One step of the simulated physics, with the servos' set-points and pushes as they are now."""
        if self.touch is None:
            mujoco.mj_step(self.world.model, self.world.data)
        else:
            self.touch.step()

    def _loop(self, log: RunLog | None, film: Film | None, progress: Progress | None) -> _Result:
        world, data = self.world, self.world.data
        controller, servos, sensors, judge = self.controller, self.servos, self.sensors, self.judge
        everything = self.scene.control.skip == "none"
        pushes, warnings = bool(self.pusher.shoves), data.warning.number
        ticks: list[float] = []
        skipped = {"percept_members": 0, "recorded_ticks": 0, "rendered_frames": 0}
        began = shown = clock.perf_counter()
        k, last = 0, math.ceil(self.end / world.period)
        longest = _LONGEST * last
        tick_every = round(self.settings.period / world.period)
        frame_every = max(1, round(1.0 / (FRAME_RATE * world.period)))
        skin_every, step_physics = sensors.skin_every, self.step_physics
        watch_step: Callable[[], int] = judge.watch.step
        drive, moving_ground = servos.drive, bool(world.moving_ground)
        while k < last and k < longest:
            feet = None
            if k % skin_every == 0:
                feet = sensors.read_skins(controller.proximity_sides, everything)
                if log is not None:
                    log.skin(sensors.readings)
            if k % tick_every == 0:
                reading = sensors.read_body()
                if self.arm is not None:
                    self.arm.step(reading.skin)
                    self.legs.hold_others(self.arm.angles)
                start = clock.perf_counter()
                command = controller.step(reading)
                joints = servos.command(command)
                ticks.append(1e6 * (clock.perf_counter() - start))
                last = math.ceil(self.end / world.period)  # a change of the plan may make it later
                skipped["percept_members"] += self.compute_rest(command, everything)
                if command.footholds:
                    self.foothold_truth.update(command.footholds)
                judge.update(command.state.com, command.state.zmp, feet, command.moved_steps)
                if self.speeds is not None:
                    self.speeds.update(data.time)
                if self.touched is not None:
                    self.touched.update(world, judge.truth().zmp)
                if self.recovery is not None:
                    plan, com = command.reference, data.subtree_com[world.torso, :2]
                    self.recovery.update(data.time, judge.truth().zmp, com, plan.vrp, plan.com)
                zmps = None if self.zmps is None else self.zmps.update(data.time, command)
                if log is not None:
                    log.tick(reading, command, controller.plan.view, joints, judge.truth())
                    if zmps is not None:
                        log.zmps(data.time, *zmps)
                else:
                    skipped["recorded_ticks"] += 1
                if judge.fall is not None:
                    if log is not None:
                        log.say(data.time, judge.fall[2], "error")
                    break
                if progress is not None and start - shown > 0.1:
                    shown = start
                    progress(
                        data.time / self.end,
                        f"{data.time:.1f} s, {len(judge.landings)} landings for {len(self.steps)} steps",
                    )
            if k % frame_every == 0:
                if film is not None:
                    film.add(sensors.readings)
                else:
                    skipped["rendered_frames"] += 1
            drive()
            if pushes:
                self.pusher.apply(world)
            if moving_ground:
                world.move_ground()
            step_physics()
            seen = watch_step()
            if seen:
                check_stable(warnings)
                judge.look(seen)
            k += 1
        if sensors.proximity:
            skipped["proximity_rays"] = sum(s.skipped for s in sensors.proximity.values())
        overrun = (float(data.time), longest * world.period / _LONGEST) if k >= longest else None
        return _Result(ticks, clock.perf_counter() - began, skipped, overrun)

    def compute_rest(self, command: Command, everything: bool) -> int:
        """Count the members of both percepts that the controller did not ask for, or compute them.

        Args:
            command: The command of this tick, with its percepts.
            everything: Compute them all, and count none.

        Returns:
            How many were left out.
        """
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

    def _summary(self, result: _Result) -> dict[str, Any]:
        world, data, judge = self.world, self.world.data, self.judge
        taken, missed = judge.steps.taken()
        position, yaw = self._final_error()
        upright = math.degrees(math.acos(min(1.0, float(data.xmat[world.torso, 8]))))
        balance = {} if self.recovery is None else self.recovery.summary()
        stopped = self.controller.safe_state
        ending = Ending(
            body=self.body,
            fall=judge.fall,
            stopped=stopped,
            steps=(taken, len(self.steps)),
            missed=missed,
            position=position if self.speeds is None else None,
            heading=yaw if self.speeds is None else None,
            tilt=upright,
            pushes=(balance.get("recovered", 0), len(balance.get("pushes", ()))),
            overrun=result.overrun,
        )
        why = reasons(ending, judge.legs, judge.joints)
        landings = [x.time for x in judge.landings]
        if self.speeds is not None:
            why += self.speeds.reasons(landings)
        if self.touched is not None:
            why += self.touched.reasons(judge.steps.last_stands())
        ticks = np.array(result.ticks_us) if result.ticks_us else np.zeros(1)
        late = self.servos.out_of_reach_since
        sole = {s: 4.0 * float(np.prod(self.robot.sole_rectangle(s)[1])) for s in SIDES}
        summary: dict[str, Any] = {
            "scene": self.scene.name,
            "robot": self.robot.name,
            "seed": self.seed,
            "completed": not why,
            "reasons": why,
            "emergency_stop": stopped is not None,
            "fell": judge.fell,
            "steps_planned": len(self.steps),
            "steps_taken": taken,
            "sim_time_s": round(float(data.time), 4),
            "wall_time_s": round(result.wall_time, 4),
            "real_time_factor": round(float(data.time) / max(result.wall_time, 1e-9), 2),
            "tilt_max_deg": round(judge.tilt_max, 3),
            "zmp_margin_min_m": round(judge.margin_min, 5) if math.isfinite(judge.margin_min) else None,
            "impacts_N": [round(x.impact, 1) for x in judge.landings],
            "landings_s": [round(x.time, 3) for x in judge.landings],
            "landing_sides": [x.side for x in judge.landings],
            "contact_area_ratio": [round(x.area / sole[x.side], 3) for x in judge.landings],
            "zmp_margins_m": [round(x.margin, 4) if math.isfinite(x.margin) else None for x in judge.landings],
            "sole_angles_deg": [None if x.angle is None else round(x.angle, 2) for x in judge.landings],
            "out_of_reach_since_s": None if late is None else round(late, 3),
            "replans": self.controller.replans,
            "moved_steps": judge.goal.summary(),
            "control_us": {
                "p50": round(float(np.percentile(ticks, 50)), 1),
                "p99": round(float(np.percentile(ticks, 99)), 1),
            },
            "skipped": result.skipped,
            "body": body_told(self.body),
            "shares": shares_told(self.scene),
            "final": {
                "position_error_m": round(position, 4),
                "heading_error_deg": round(yaw, 3),
                "tilt_deg": round(upright, 3),
                "height_m": round(judge.height, 4),
            },
            "slip_max_m": round(judge.steps.slip, 4),
            **judge.joints.summary(),
            "estimate": {
                "com_error_max_m": [round(float(v), 4) for v in judge.estimate_error_max],
                "zmp_error_rms_m": None if judge.zmp_error is None else round(judge.zmp_error, 5),
            },
        }
        summary |= self._of_parts(landings, balance)
        return summary

    def _of_parts(self, landings: list[float], balance: dict[str, Any]) -> dict[str, Any]:
        """What only some scenes have to say."""
        found: dict[str, Any] = {}
        if self.plant is not None:
            found["plant"] = self.plant.summary()
        if self.speeds is not None:
            found["velocity"] = self.speeds.summary(landings)
        identified = self.controller.identified()
        if identified:
            found["identified"] = identified
        footholds = self.foothold_truth.summary()
        if footholds:
            found["footholds"] = dict(footholds)
        if self.ground.facts:
            found["terrain"] = dict(self.ground.facts)
        if self.zmps is not None:
            balance["skin_against_force_torque"] = self.zmps.summary()
        if balance:
            found["balance"] = balance
        if self.controller.balance.states:
            found["wrench_distribution"] = dict(self.controller.balance.states)
        if self.controller.guard is not None:
            found |= self.controller.guard.summary()
        if self.touched is not None:
            start = 0.5 * sum(self.feet[side].x + self._centers[side][0] for side in SIDES)
            walked = float(self.world.data.subtree_com[self.world.torso, 0]) - start
            found |= self.touched.summary(self.judge.steps.last_stands(), walked)
        if self.pusher.step is not None:
            found["push"] = {
                "impulse_Ns": round(self.scene.push.strength, 4),
                "dv_m_s": round(self.scene.push.strength / self.body.mass, 4),
                "direction": self.pusher.direction,
                "step": self.pusher.step,
                "time_s": round(self.pusher.shoves[0].start, 3),
            }
        return found

    def _final_error(self) -> tuple[float, float]:
        """Distance in m and heading error in degrees of the true torso from the end of the walk's goal.

        That is as planned at the start or as planned anew, whichever is nearer: steps that are moved because dead
        reckoning is off come to lie where they were planned at the start.
        """
        world, data = self.world, self.world.data
        com = data.subtree_com[world.torso, :2]
        ends = [self.judge.goal.end(self._centers, at_start=at_start) for at_start in (False, True)]
        end, wanted = min(ends, key=lambda goal: math.dist(goal[0], com))
        heading = math.atan2(float(data.xmat[world.torso, 3]), float(data.xmat[world.torso, 0]))
        return float(np.hypot(*(com - end))), abs(math.degrees(math.remainder(heading - wanted, 2.0 * math.pi)))


def _worn(robot: Robot, arm: ArmSettings) -> WornArm | None:
    """The arm that moves; None for a robot whose arms are part of its chest."""
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
    """Run one scene.

    Args:
        scene: The scene.
        seed: Seed of sensor noise and of what the scene leaves to chance.
        layouts: Sole layouts to wear instead of the robot's own.
        record: MCAP file to write.
        video: MP4 file to write.
        progress: Called about ten times a second with the fraction done and a text.

    Returns:
        The summary (see `Simulation.run`).
    """
    return Simulation(scene, seed, layouts).run(record=record, video=video, progress=progress)
