"""Run one scenario: physics, skin, control and judge in one loop."""

from __future__ import annotations

import math
import os
import time as clock
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from gait.balance_laws import balance_gains
from gait.compliance_gains import ComplianceGains
from gait.controller import Command, ControllerSettings, WalkingController
from gait.estimator import EstimatorGains
from gait.feasibility import FeasibilityRules
from gait.foot_motion import Landing
from gait.footholds import middle_of_sole
from gait.footsteps import Footstep, straight_plan
from gait.ground_conformity import ConformityGains
from gait.phases import Timing
from gait.walk_plan import vrp_of_step
from plantar.errors import SceneError
from plantar.layout import Side, SoleLayout
from plantar.percept import Percept
from sim.foothold_truth import FootholdTruth
from sim.judge import Judge
from sim.log import RunLog
from sim.pushing import Pusher
from sim.recovery import Recovery
from sim.render import FRAME_RATE, Film
from sim.robots.robot import Robot, load_robot
from sim.scene import Scene
from sim.sensors import SensorSuite, ankle_sensors
from sim.servos import LegServos
from sim.standing import stand
from sim.terrain import Footprint, PlannedFeet
from sim.world import PHYSICS_PERIOD, World, build_leg_model, build_world, check_stable
from sim.zmp_comparison import ZmpComparison

__all__ = ["Simulation", "run_scene"]

Progress = Callable[[float, str], None]

CONTROL_PERIOD = 0.005
"""Control period of both robots in s."""

_YAW_ON_UNKNOWN_GROUND = 0.1
"""Heading correction by the loaded feet in 1/s where they meet ground that is not where it is expected: they turn a
little as they land, which only the gyro shows. (Corrected by 2.0 a walk of 100 steps drifted 42 mm off to the side.)"""

_SIDES: tuple[Side, Side] = ("left", "right")
_MEMBERS = frozenset(Percept.members())
_EVERY = round(CONTROL_PERIOD / PHYSICS_PERIOD)
_FRAME_EVERY = round(1.0 / (FRAME_RATE * PHYSICS_PERIOD))


@dataclass(frozen=True)
class _Result:
    """What a run leaves behind for its summary."""

    ticks_us: list[float]
    wall_time: float
    skipped: dict[str, int]


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
        self.scene = scene
        self.seed = seed
        robot = load_robot(scene.robot)
        if layouts is not None:
            robot = replace(robot, layouts=dict(layouts))
        self.robot: Robot = robot
        self.legs = build_leg_model(robot)
        walk = scene.walk
        self.feet, self.steps = straight_plan(
            walk.steps,
            length=walk.length,
            sideways=walk.sideways,
            width=walk.stance_width or robot.stance_width,
            first="left" if walk.first == "left" else "right",
            height=scene.terrain.height,
        )
        crouch = robot.largest_crouch if scene.terrain.whole else robot.largest_crouch_partial
        self.settings = ControllerSettings(
            com_height=robot.com_height - min(walk.crouch, crouch),
            mass=self.legs.mass,
            trunk_lean=robot.trunk_lean if walk.lean else 0.0,
            period=CONTROL_PERIOD,
            timing=Timing(
                walk.single_support or robot.single_support,
                walk.double_support or robot.double_support,
                walk.start,
                walk.end,
                walk.settle,
            ),
            swing_height=walk.swing_height,
            landing=Landing(approach_height=walk.approach_height, approach_speed=walk.approach_speed),
            compliance=ComplianceGains(sensing_range=scene.sensing.proximity_range) if scene.control.pfc else None,
            feasibility=self._feasibility(scene),
            conformity=self._conformity(scene),
            estimator=EstimatorGains(yaw=_YAW_ON_UNKNOWN_GROUND) if scene.control.pfc else EstimatorGains(),
            gains=balance_gains(robot.balance),
            feedback=scene.control.feedback,
            zmp_source=scene.control.zmp_source,
            ankles=ankle_sensors(self.legs.model, robot),
            footholds=scene.control.footholds,
        )
        self.controller = WalkingController(
            self.settings, self.feet, self.steps, robot.layouts, self.legs, begin=walk.begin
        )
        ground = scene.terrain.ground(self._planned_feet(), np.random.default_rng([seed, 0x7E]))
        self.ground = ground
        self.world: World = build_world(robot, ground)
        self.sensors = SensorSuite(
            self.world,
            scene.sensing,
            seed,
            proximity=scene.control.pfc or scene.control.footholds == "skin",
            force_torque=scene.sensing.force_torque
            or "force_torque" in (scene.control.zmp_source, scene.control.feasibility),
        )
        self.servos = LegServos(self.world, self.legs, CONTROL_PERIOD)
        self.pusher = Pusher(scene.push, self.controller.schedule, seed)
        self.recovery = Recovery(self.pusher.shoves, self.controller.end) if scene.push.count else None
        self.zmps: ZmpComparison | None = None
        if scene.sensing.force_torque:
            self.zmps = ZmpComparison(robot.layouts, scene.sensing.force_noise, CONTROL_PERIOD)
        centers = {}
        for side in _SIDES:
            centers[side] = vrp_of_step(self.feet[side], middle_of_sole(robot.layouts[side]))
        stand(self.world, self.legs, self.servos, self.feet, centers, self.settings.com_height)
        self.foothold_truth = FootholdTruth(self.world, ground)
        self.judge = Judge(self.world, self.settings.com_height)

    @staticmethod
    def _feasibility(scene: Scene) -> FeasibilityRules | None:
        if scene.control.feasibility == "off":
            return None
        if not scene.control.pfc:
            raise SceneError(f"control.feasibility is '{scene.control.feasibility}'; allowed: off, or with pfc = true")
        return FeasibilityRules(rule=scene.control.feasibility)

    @staticmethod
    def _conformity(scene: Scene) -> ConformityGains | None:
        if not scene.control.conform:
            return None
        if not scene.control.pfc:
            raise SceneError("control.conform is true; allowed: with pfc = true")
        return ConformityGains()

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
            {side: footprint(self.feet[side], None) for side in _SIDES},
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
                log = stack.enter_context(RunLog(Path(record), self.world, self._identity(), zmps=bool(self.zmps)))
            if video is not None:
                film = stack.enter_context(Film(video, self.world))
            result = self._loop(log, film, progress)
        return self._summary(result)

    def _loop(self, log: RunLog | None, film: Film | None, progress: Progress | None) -> _Result:
        world, model, data = self.world, self.world.model, self.world.data
        controller, servos, sensors, judge = self.controller, self.servos, self.sensors, self.judge
        everything = self.scene.control.skip == "none"
        ticks: list[float] = []
        skipped = {"percept_members": 0, "recorded_ticks": 0, "rendered_frames": 0}
        began = shown = clock.perf_counter()
        k = 0
        while k < math.ceil(controller.end / PHYSICS_PERIOD):  # a replan may make it later
            feet = None
            if k % sensors.skin_every == 0:
                feet = sensors.sample_skin(controller.proximity_sides, everything)
                if log is not None:
                    log.skin(sensors.readings)
            if k % _EVERY == 0:
                check_stable(data)
                reading = sensors.sample_body()
                start = clock.perf_counter()
                command = controller.step(reading)
                joints = servos.command(command)
                ticks.append(1e6 * (clock.perf_counter() - start))
                skipped["percept_members"] += _compute_rest(command, everything)
                if command.footholds:
                    self.foothold_truth.look(command.footholds)
                truth = judge.look(command.state.com, command.state.zmp, feet)
                if self.recovery is not None:
                    plan, com = command.reference, data.subtree_com[world.torso, :2]
                    self.recovery.look(data.time, truth.zmp, com, plan.vrp, plan.com)
                zmps = None if self.zmps is None else self.zmps.look(data.time, command)
                if log is not None:
                    log.tick(reading, command, joints, truth)
                    if zmps is not None:
                        log.zmps(data.time, *zmps)
                else:
                    skipped["recorded_ticks"] += 1
                if judge.fell:
                    break
                if progress is not None and start - shown > 0.1:
                    shown = start
                    progress(
                        data.time / controller.end,
                        f"{data.time:.1f} s, {len(judge.landings)} of {len(self.steps)} steps",
                    )
            if k % _FRAME_EVERY == 0:
                if film is not None:
                    film.add()
                else:
                    skipped["rendered_frames"] += 1
            servos.drive()
            self.pusher.apply(world)
            if world.moving_ground:
                world.move_ground()
            mujoco.mj_step(model, data)
            judge.watch()
            k += 1
        if sensors.proximity:
            skipped["proximity_rays"] = sum(s.skipped for s in sensors.proximity.values())
        return _Result(ticks, clock.perf_counter() - began, skipped)

    def _identity(self) -> dict[str, object]:
        return {
            "scene": self.scene.name,
            "robot": self.robot.name,
            "seed": self.seed,
            "mass_kg": self.legs.mass,
            "ground": self.ground.seen_from_above(),
            "settings": {
                name: asdict(getattr(self.scene, name)) for name in ("terrain", "walk", "sensing", "push", "control")
            },
        }

    def _summary(self, result: _Result) -> dict[str, Any]:
        world, data, judge = self.world, self.world.data, self.judge
        taken = min(len(judge.landings), len(self.steps))
        position, yaw = self._final_error()
        upright = math.degrees(math.acos(min(1.0, float(data.xmat[world.torso, 8]))))
        completed = not judge.fell and taken == len(self.steps) and position < 0.10 and yaw < 5.0 and upright < 5.0
        balance = {} if self.recovery is None else self.recovery.summary()
        completed = completed and balance.get("recovered", 0) == len(balance.get("pushes", ()))
        ticks = np.array(result.ticks_us) if result.ticks_us else np.zeros(1)
        late = self.servos.out_of_reach_since
        sole = {s: 4.0 * float(np.prod(self.robot.sole_rectangle(s)[1])) for s in _SIDES}
        summary: dict[str, Any] = {
            "scene": self.scene.name,
            "robot": self.robot.name,
            "seed": self.seed,
            "completed": bool(completed),
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
            "control_us": {
                "p50": round(float(np.percentile(ticks, 50)), 1),
                "p99": round(float(np.percentile(ticks, 99)), 1),
            },
            "skipped": result.skipped,
            "final": {
                "position_error_m": round(position, 4),
                "heading_error_deg": round(yaw, 3),
                "tilt_deg": round(upright, 3),
            },
            "estimate": {
                "com_error_max_m": [round(float(v), 4) for v in judge.estimate_error_max],
                "zmp_error_rms_m": round(float(np.sqrt(np.mean(np.square(judge.zmp_error)))), 5)
                if judge.zmp_error
                else None,
            },
        }
        footholds = self.foothold_truth.summary()
        if footholds:
            summary["footholds"] = dict(footholds)
        if self.ground.facts:
            summary["terrain"] = dict(self.ground.facts)
        if self.zmps is not None:
            balance["skin_against_force_torque"] = self.zmps.summary()
        if balance:
            summary["balance"] = balance
        if self.controller.balance.states:
            summary["wrench_distribution"] = dict(self.controller.balance.states)
        if self.controller.guard is not None:
            summary |= self.controller.guard.summary()
        if self.pusher.step is not None:
            summary["push"] = {
                "impulse_Ns": self.scene.push.impulse,
                "direction": self.pusher.direction,
                "step": self.pusher.step,
                "time_s": round(self.pusher.shoves[0].start, 3),
            }
        return summary

    def _final_error(self) -> tuple[float, float]:
        """Distance in m and heading error in degrees of the true torso from the plan's end."""
        world, data = self.world, self.world.data
        com = data.subtree_com[world.torso, :2]
        plan = self.controller.plan.end
        heading = math.atan2(float(data.xmat[world.torso, 3]), float(data.xmat[world.torso, 0]))
        wanted = self.steps[-1].yaw if self.steps else self.feet["left"].yaw
        return float(np.hypot(*(com - plan))), abs(math.degrees(math.remainder(heading - wanted, 2.0 * math.pi)))


def _compute_rest(command: Command, everything: bool) -> int:
    """Count the members of both percepts that the controller did not ask for; compute them where all is wanted."""
    count = 0
    for percept in command.percepts.values():
        if everything:
            for name in _MEMBERS:
                getattr(percept, name)
        else:
            count += len(_MEMBERS) - len(_MEMBERS.intersection(percept.__dict__))
    return count


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
