"""The summary of a finished run."""

import math
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale, si_unit
from plantar.common.settings.schema import Settings
from plantar.common.sides import SIDES
from plantar.gait.controller import WalkingController
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.layouts.layout import Side
from plantar.robots.robot import Robot
from plantar.sim.judging.foothold_truth import FootholdTruth
from plantar.sim.judging.judge import Judge
from plantar.sim.judging.recovery import Recovery
from plantar.sim.judging.run_limits import limit_reasons
from plantar.sim.judging.step_count import Count
from plantar.sim.judging.velocity_truth import VelocityTruth
from plantar.sim.judging.verdict import Ending, reasons
from plantar.sim.judging.zmp_comparison import ZmpComparison
from plantar.sim.loop import Result
from plantar.sim.model.world import World
from plantar.sim.plant.draw import TruePlant
from plantar.sim.run.motor_drives import MotorDrives
from plantar.sim.run.pushing import Pusher
from plantar.sim.run.scene import SECTIONS, Scene
from plantar.sim.run.servos import LegServos
from plantar.sim.run.touched import Touched
from plantar.sim.terrain import Ground, PlannedFeet


class FinishedRun(Protocol):
    """Parts of a run that its summary reads."""

    scene: Scene
    robot: Robot
    seed: int
    body: BodyScale
    world: World
    ground: Ground
    plant: TruePlant | None
    controller: WalkingController
    servos: LegServos | MotorDrives
    feet: dict[Side, Footstep]
    steps: tuple[Footstep, ...]
    centers: dict[Side, NDArray[np.float64]]
    judge: Judge
    foothold_truth: FootholdTruth
    planned: PlannedFeet
    pusher: Pusher
    recovery: Recovery | None
    speeds: VelocityTruth | None
    touched: Touched | None
    zmps: ZmpComparison | None

    def common(
        self, result: Result, names: tuple[str, str], reasons: list[dict[str, Any]], fell: bool, time: float
    ) -> dict[str, Any]:
        """Returns `plantar.sim.loop.Run.common` of `result`, `names`, `reasons`, `fell`, `time`."""
        ...


def summary_of(run: FinishedRun, result: Result) -> dict[str, Any]:
    """Returns the summary of a `run` by its loop's `result`; None: not measured."""
    judge = run.judge
    stopped = run.controller.safe_state
    late = run.servos.out_of_reach_since
    count = judge.steps.count()
    balance = {} if run.recovery is None else run.recovery.summary(run.pusher.applied)
    final, why = verdict_of(run, count, balance, result.overrun)
    return {
        **run.common(result, (run.scene.name, run.robot.name), why, judge.fell, float(run.world.data.time)),
        "emergency_stop": stopped is not None,
        "steps_planned": len(run.steps) if run.speeds is None else None,
        "steps_taken": count.taken if run.speeds is None else len(judge.steps.last_stands()),
        "tilt_max_deg": round(judge.tilt_max, 3),
        "zmp_margin_min_m": None if judge.margin_min is None else round(judge.margin_min, 5),
        **_of_landings(run),
        "out_of_reach_since_s": None if late is None else round(late, 3),
        "replans": run.controller.replans,
        "moved_steps": judge.goal.summary(),
        "body": size_of(run.body),
        "shares": shares_of(run.scene),
        "final": final,
        "drift": {
            "position_m": round(math.hypot(*count.drift), 4),
            "heading_deg": round(math.degrees(count.turned), 3),
            "way_m": round(judge.goal.way_to(count.taken - 1), 4),
        }
        if count.taken
        else None,
        "slip_max_m": round(judge.steps.slip, 4),
        **judge.ripple.summary(),
        **judge.joints.summary(),
        "estimate": {
            "com_error_max_m": [round(float(v), 4) for v in judge.estimate_error_max],
            "zmp_error_rms_m": None if judge.zmp_error is None else round(judge.zmp_error, 5),
        },
        **_of_parts(run, balance),
    }


def _of_landings(run: FinishedRun) -> dict[str, list[Any]]:
    landed = run.judge.landings
    sole = {s: 4.0 * float(np.prod(run.robot.sole_rectangle(s)[1])) for s in SIDES}
    return {
        "impacts_N": [round(x.impact, 1) for x in landed],
        "landings_s": [round(x.time, 3) for x in landed],
        "landing_sides": [x.side for x in landed],
        "contact_area_ratio": [round(x.area / sole[x.side], 3) for x in landed],
        "zmp_margins_m": [None if x.margin is None else round(x.margin, 4) for x in landed],
        "sole_angles_deg": [None if x.angle is None else round(x.angle, 2) for x in landed],
    }


def verdict_of(
    run: FinishedRun, count: Count, balance: dict[str, Any], overrun: tuple[float, float] | None = None
) -> tuple[dict[str, float], list[dict[str, Any]]]:
    """Returns how a `run` ended, and all criteria that it failed.

    By its steps' `count`, figures of its `balance`, and cut and first planned end in s, or None, of an `overrun`.
    """
    world = run.world
    judge = run.judge
    ends = [judge.goal.end(run.centers, at_start=at_start) for at_start in (False, True)]
    position, yaw = _final_error(run, ends if run.speeds is None else [run.speeds.course])
    # Where all steps were taken, the feet are where they have to be, and the body has to be over them.
    off, turned = _final_error(run, [_over_feet(run, count)]) if 0 < count.taken == len(run.steps) else (position, yaw)
    upright = math.degrees(math.acos(min(1.0, float(world.data.xmat[world.torso, 8]))))
    ending = Ending(
        body=run.body,
        fall=judge.fall,
        stopped=run.controller.safe_state,
        raised=run.controller.raised,
        steps=(count.taken, len(run.steps)),
        missed=count.missed,
        position=off if run.speeds is None else None,
        heading=turned if run.speeds is None else None,
        tilt=upright,
        pushes=(balance.get("recovered", 0), len(balance.get("pushes", ()))),
        overrun=overrun,
    )
    why = reasons(ending, judge.legs, judge.joints)
    if judge.fall is None:  # a robot that falls rattles on any ground
        why += judge.ripple.reasons()
    if run.speeds is not None:
        why += run.speeds.reasons([x.time for x in judge.landings])
    impacts = [landing.impact / run.body.weight for landing in judge.landings]
    why += limit_reasons(impacts, run.ground.level_at(run.scene.terrain.height), judge.joints.share_at_limit)
    why += judge.others.reasons() + judge.outside.reasons()
    if run.touched is not None:
        why += run.touched.support.reasons()
    for criterion in run.scene.outcome.values():
        why += criterion.reasons(run)
    final = {
        "position_error_m": round(position, 4),
        "heading_error_deg": round(yaw, 3),
        "tilt_deg": round(upright, 3),
        "height_m": round(judge.height, 4),
    }
    return final, why


def _of_parts(run: FinishedRun, balance: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    if run.plant is not None:
        found["plant"] = run.plant.summary()
    if run.speeds is not None:
        found["velocity"] = run.speeds.summary([x.time for x in run.judge.landings])
    identified = run.controller.identified()
    if identified:
        found["identified"] = identified
    footholds = run.foothold_truth.summary()
    if footholds:
        found["footholds"] = dict(footholds)
    if run.ground.facts:
        found["terrain"] = dict(run.ground.facts)
    if run.zmps is not None:
        balance["skin_against_force_torque"] = run.zmps.summary()
    if balance:
        found["balance"] = balance
    if run.controller.balance.states:
        found["wrench_distribution"] = dict(run.controller.balance.states)
    if run.controller.footing.guard is not None:
        found |= run.controller.footing.guard.summary()
    if run.touched is not None:
        start = 0.5 * sum(run.feet[side].x + run.centers[side][0] for side in SIDES)
        walked = float(run.world.data.subtree_com[run.world.torso, 0]) - start
        found |= run.touched.summary(run.judge.steps.last_stands(), walked)
    if run.pusher.step is not None:
        applied = float(np.linalg.norm(run.pusher.applied[0])) if run.pusher.applied else None
        found["push"] = {
            "impulse_Ns": None if applied is None else round(applied, 4),
            "asked_Ns": round(run.scene.push.strength, 4),
            "dv_m_s": None if applied is None else round(applied / run.body.mass, 4),
            "direction": run.pusher.direction,
            "step": run.pusher.step,
            "time_s": round(run.pusher.shoves[0].start, 3),
        }
    return found


def _over_feet(run: FinishedRun, count: Count) -> tuple[NDArray[np.float64], float]:
    """Middle (2,) in m between soles' centres at their last steps, and last heading in rad."""
    feet = dict(run.feet)
    for stand in count.stands:
        feet[stand.side] = Footstep(stand.side, *stand.place)
    middle = 0.5 * sum(vrp_of_step(feet[side], run.centers[side]) for side in SIDES)
    return np.asarray(middle), count.stands[-1].place[2]


def _final_error(run: FinishedRun, ends: Sequence[tuple[NDArray[np.float64], float]]) -> tuple[float, float]:
    """The true torso's distance in m and heading error in degrees from the walk's nearest end.

    A walk ends as planned first or last: steps moved against drift lie as planned first.
    """
    world = run.world
    data = run.world.data
    com = data.subtree_com[world.torso, :2]
    end, wanted = min(ends, key=lambda goal: math.dist(goal[0], com))
    heading = math.atan2(float(data.xmat[world.torso, 3]), float(data.xmat[world.torso, 0]))
    return float(np.hypot(*(com - end))), abs(math.degrees(math.remainder(heading - wanted, 2.0 * math.pi)))


def size_of(body: BodyScale) -> dict[str, float]:
    """Size of a body by name and unit, for JSON."""
    return {
        "mass_kg": round(body.mass, 4),
        "weight_N": round(body.weight, 3),
        "leg_m": round(body.leg, 6),
        "sole_m": round(body.sole, 6),
        "sole_width_m": round(body.sole_width, 6),
        "beat_s": round(body.beat, 6),
        "pace_s": round(body.pace, 6),
    }


def shares_of(scene: Scene) -> dict[str, dict[str, Any]]:
    """ "share", "value" in SI and "unit" of a scene's body shares, by dotted name.

    The scene is a robot's (`Scene.for_body`).

    Example:
        >>> from plantar.sim.run.scene import load_scene
        >>> shares_of(load_scene("flat"))["walk.length"]
        {'share': '0.3333 leg', 'value': 0.2, 'unit': 'm'}
    """
    return {
        f"{section}.{name}": share for section in SECTIONS for name, share in _shares(getattr(scene, section)).items()
    }


def _shares(settings: Settings) -> dict[str, dict[str, Any]]:
    return {
        name: {
            "share": str(share),
            "value": float(f"{getattr(settings, name):.6g}"),
            "unit": si_unit(share.unit),
        }
        for name, share in settings.stated.items()
    }
