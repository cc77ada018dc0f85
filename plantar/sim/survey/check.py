"""Obstacles to a robot's walk in a scene, measured without physics."""

import math
import os
from dataclasses import asdict, dataclass, replace
from typing import Any

import mujoco
import numpy as np
from scipy.spatial import ConvexHull

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.robots.controller_settings import controller_settings
from plantar.robots.kinematics.ankle_sensors import ankle_sensors
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.command_joints import SPEED_SHARE
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot import Robot
from plantar.robots.robot_file import load_robot
from plantar.robots.survey.fitted_gait import ROLL_MOST
from plantar.robots.survey.plan_reach import PlanReach, Walked, plan_reach, settled, speed_shares
from plantar.robots.survey.robot_text import roll_pitch_yaw
from plantar.robots.survey.servo_gains import CHATTERS, DAMPED, LEAST_STIFFNESS, joint_inertia, servo_gains
from plantar.robots.survey.sole_frame import level_axes, rested
from plantar.robots.survey.step_search import HELD, SPARE
from plantar.robots.walk import CONTROL_PERIOD
from plantar.sim.run.scene import Scene, load_scene

_STEPS = 8  # of a longer walk: the others are as these
_BENT = math.radians(8.0)  # of a knee: below it inverse kinematics damps, and the CoM is no longer free
_MISSED = 0.01  # m by which feet or CoM may miss the plan: the three G1s walk with 3 to 5 mm
_TILT = math.radians(2.0)  # of a sole against the foot that it hangs on: a shoe gives way by about as much
_BELOW = 2e-3  # m of a foot below its shoe's inner face: printer tolerance and rounded edges
_BESIDE = 0.05  # of the sole's width, by which foot and shoe may reach past each other
_BAND = 5e-3  # m: the lowest part of a foot, which is its sole
_APART = 0.05  # of the sole's width between two soles side by side
_HIGHEST = 1.0  # of a torque limit
_ROCKING = 1.5  # the same of quick steps that rock: H1 walks with 1.4, at its ankles' limit for a tenth of the time
_HURRIED = 2.0  # of a usable speed: h1 walks level ground at 1.3, and with limits so low that it is 2.2
_MOVING = 1.2  # of a torque limit: what is missing for some ticks, the other joints make up for


@dataclass(frozen=True)
class Finding:
    """One measured thing. `limit`: most or least that the value may be."""

    name: str
    value: float
    limit: float
    unit: str
    holds: bool
    text: str


@dataclass(frozen=True)
class RobotCheck:
    """Measured of a robot in a scene."""

    robot: str
    scene: str
    findings: tuple[Finding, ...]

    @property
    def holds(self) -> bool:
        """Whether all hold."""
        return all(f.holds for f in self.findings)

    @property
    def failures(self) -> list[str]:
        """Findings that do not hold, a line each."""
        return [f"{f.name}: {f.text}" for f in self.findings if not f.holds]

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values."""
        found = [{k: None if v in (math.inf, -math.inf) else v for k, v in asdict(f).items()} for f in self.findings]
        return {"robot": self.robot, "scene": self.scene, "holds": self.holds, "findings": found}

    def text(self) -> str:
        """As text."""
        lines = [f"  {'ok  ' if f.holds else 'FAIL'} {f.name}: {f.text}" for f in self.findings]
        end = "nothing found that would go wrong" if self.holds else "something would go wrong"
        return "\n".join([f"{self.robot} in {self.scene}: {end}", *lines])


def check_robot(file: str | os.PathLike[str], scene: str) -> RobotCheck:
    """Returns what was measured of a robot `file` or name for a `scene`'s plan.

    Raises:
        RobotError, SceneError: If an argument is invalid.
    """
    return _Checked(load_robot(file), load_scene(scene, robot=str(file))).result()


class _Checked:
    def __init__(self, robot: Robot, scene: Scene) -> None:
        self.robot = robot
        self.legs: LegModel = build_leg_model(robot)
        self.body: BodyScale = body_of(robot, self.legs.model)
        self.scene = scene.for_body(self.body)
        self.names = robot.legs["left"].joints
        self.walked = self._walked()

    def result(self) -> RobotCheck:
        stands = settled(self.robot, self.legs, self.walked.feet, self.walked.com_height)
        model = self.legs.model
        gains = self._gains(self.legs.model, self.legs.configuration)
        reach = plan_reach(self.robot, self.legs, self.walked)
        found = [*self._reach(reach, stands), self._apart(), *gains, *self._soles(model)]
        if math.isfinite(reach.shift):  # the legs followed the plan to its end
            found += [*self._torques(reach), *self._speed(reach)]
        return RobotCheck(self.robot.name, self.scene.name, tuple(found))

    def _walked(self) -> Walked:
        walk = self.scene.walk
        robot = self.robot
        feet, plan = self._planned(min(walk.steps if walk.velocities(0) is None else _STEPS, _STEPS), 1.0)
        settings = controller_settings(self.scene, robot, self.body, ankle_sensors(self.legs.model, robot))
        return Walked(
            feet,
            plan,
            settings.timing,
            walk.swing_height,
            settings.com_height,
            settings.trunk_lean,
            settings.landing.approach_height,
            settings.landing.approach_speed,
        )

    def _planned(self, count: int, share: float) -> tuple[dict[Side, Footstep], tuple[Footstep, ...]]:
        walk = self.scene.walk
        return straight_plan(
            count,
            length=share * walk.length,
            sideways=share * walk.sideways,
            width=walk.stance_width or self.robot.stance_width,
            first="left" if walk.first == "left" else "right",
        )

    def _reach(self, reach: PlanReach, stands: float) -> list[Finding]:
        holds = max(reach.missed, stands) <= _MISSED and reach.knee >= _BENT
        bend = math.degrees(reach.knee)
        text = (
            f"the straightest knee is bent by {bend:.0f} degrees {reach.straightest:.1f} s into the walk, feet and CoM "
            f"are missed by {1e3 * reach.missed:.1f} mm or mrad"
        )
        if not holds:  # joints and soles were not followed to the end
            works = self._working_height()
            text += f"; allowed: {math.degrees(_BENT):.0f} degrees or more and {1e3 * _MISSED:.0f} mm; "
            text += self._working_length() if works is None else f"com_height = {works:.3f} works"
            return [Finding("reach", round(bend, 2), math.degrees(_BENT), "degrees", holds, text)]
        spare = min(float(reach.spare.min()), math.pi)
        joint = self.names[int(reach.spare.argmin())]
        held = spare >= SPARE
        range_text = f"{joint} comes within {math.degrees(spare):.2f} degrees of its limit" + _unless(
            held, f"; allowed: {math.degrees(SPARE):.1f} or more: another com_height or stance_width, or a wider range"
        )
        # Rocking legs lean with their soles until the CoM is over the sole's middle.
        half = 0.5 * (self.walked.feet["left"].y - self.walked.feet["right"].y)
        most = math.atan(half / self.walked.com_height) if self.robot.rocks else ROLL_MOST
        roll = math.degrees(reach.roll)
        level = reach.roll <= most
        roll_text = f"a sole that carries alone is off level by {roll:.1f} degrees" + _unless(
            level, f"; allowed: {math.degrees(most):.3g}; legs with an ankle that rolls work, or a scene that stands"
        )
        return [
            Finding("level soles", round(roll, 2), round(math.degrees(most), 2), "degrees", level, roll_text),
            Finding("reach", round(bend, 2), math.degrees(_BENT), "degrees", holds, text),
            Finding("joint range", round(math.degrees(spare), 2), math.degrees(SPARE), "degrees", held, range_text),
        ]

    def _working_height(self) -> float | None:
        low = self.walked.com_height
        for _ in range(12):
            low -= 0.03 * self.body.leg
            found = plan_reach(self.robot, self.legs, replace(self.walked, com_height=low))
            if found.missed <= _MISSED and found.knee >= 2.0 * _BENT:
                return low + self.robot.com_height - self.walked.com_height
        return None

    def _working_length(self) -> str:
        walk = self.scene.walk
        for share in (0.8, 0.6, 0.4, 0.2):
            feet, plan = self._planned(len(self.walked.steps), share)
            found = plan_reach(self.robot, self.legs, replace(self.walked, feet=feet, steps=plan))
            if found.missed <= _MISSED and found.knee >= _BENT:
                return f"walk.length = {share * walk.length:.3f} with walk.sideways = {share * walk.sideways:.3f} works"
        return "no height and no shorter step works: see [posture] and the joints' limits"

    def _apart(self) -> Finding:
        outlines = {s: self.robot.layouts[s].outline[:, 1] for s in SIDES}
        feet = self.walked.feet
        gap = float(feet["left"].y + outlines["left"].min() - feet["right"].y - outlines["right"].max())
        least = _APART * self.body.sole_width
        width = feet["left"].y - feet["right"].y + 0.25 * self.body.sole_width - gap
        text = f"the soles stand {1e3 * gap:.0f} mm apart" + _unless(
            gap >= least, f"; allowed: {1e3 * least:.0f} mm or more; stance_width = {width:.3f} works"
        )
        return Finding("stance", round(1e3 * gap, 1), round(1e3 * least, 1), "mm", gap >= least, text)

    def _gains(self, model: Any, configuration: Any) -> list[Finding]:
        robot = self.robot
        body = self.body
        inertia = joint_inertia(robot, model, configuration)
        stiffness = np.array(robot.stiffness)
        damping = np.array(robot.damping)
        works, damped = servo_gains(inertia, body.mass, robot.com_height, body.beat, CONTROL_PERIOD)
        swing = np.sqrt(stiffness / inertia.swing) * CONTROL_PERIOD
        allowed = CHATTERS * np.maximum(1.0, np.sqrt(works / stiffness))
        quick = np.where(stiffness <= 1.05 * works, 0.0, swing)
        j = int(quick.argmax() if quick.any() else swing.argmax())
        holds = bool(quick[j] <= allowed[j])
        text = (
            f"{self.names[j]} swings by {swing[j]:.2f} rad in a control period of {1e3 * CONTROL_PERIOD:g} ms"
            + _unless(
                holds,
                f" ({stiffness[j]:g} N m/rad on {inertia.swing[j]:.3g} kg m^2): it chatters; allowed: "
                f"{CHATTERS:g} rad; stiffness = {works[j]:g} and damping = {damped[j]:g} work",
            )
        )
        least = LEAST_STIFFNESS * body.weight * robot.com_height
        k = int(stiffness.argmin())
        held = bool(stiffness[k] >= 0.95 * least)
        soft_text = f"{self.names[k]} has {stiffness[k]:g} N m/rad" + _unless(
            held,
            f": too soft to stand on; allowed: {LEAST_STIFFNESS:g} m g h = {least:.3g} or more; {works[k]:g} works",
        )
        ratio = (damping + inertia.damping) / (2.0 * np.sqrt(stiffness * inertia.swing))
        d = int(ratio.argmin())
        calm = bool(ratio[d] >= DAMPED)
        damping_text = f"{self.names[d]} is damped by {ratio[d]:.2f} of critical while it swings" + _unless(
            calm, f"; allowed: {DAMPED:g} or more; damping = {damped[d]:g} works"
        )
        return [
            Finding("stiff servos", round(float(swing[j]), 3), CHATTERS, "rad", holds, text),
            Finding("soft servos", float(stiffness[k]), round(least, 2), "N m/rad", held, soft_text),
            Finding("damping", round(float(ratio[d]), 3), DAMPED, "1", calm, damping_text),
        ]

    def _soles(self, model: Any) -> list[Finding]:
        if self.robot.kind == "biped":
            return []
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        found = []
        for side in SIDES:
            parts = _foot_parts(model, self.robot.legs[side].foot_body, self.robot.legs[side].sole_site)
            site = model.site(self.robot.legs[side].sole_site).id
            to_sole = data.site_xmat[site].reshape(3, 3).T
            foot = rested(model, data, parts, to_sole)
            if foot is None:
                continue
            points = foot.surface.reshape(-1, 3)
            to_body = np.array(self.robot.sole_rotations[side])
            normal = foot.normal if foot.share >= 0.25 else np.array([0.0, 0.0, -1.0])  # of a rounded sole
            lowest = float((points @ -normal).min())
            tilt = math.acos(min(1.0, -float(normal[2])))
            turned = level_axes(normal)
            key = "_right" * (side == "right")
            shank = data.xanchor[model.joint(self.robot.legs[side].joints[-3]).id]
            if float((to_sole @ (shank - data.site_xpos[site]))[2]) < 0.0:
                # the leg is below
                tilt = math.pi - tilt
                turned = turned @ np.diag([1.0, -1.0, -1.0])
            level = tilt <= _TILT
            text = f"it is tilted by {math.degrees(tilt):.1f} degrees against the foot" + _unless(
                level, f"; allowed: {math.degrees(_TILT):g}; rotation{key} = {roll_pitch_yaw(to_body @ turned)} works"
            )
            found.append(
                Finding(f"{side} sole", round(math.degrees(tilt), 2), math.degrees(_TILT), "degrees", level, text)
            )
            place = to_sole @ data.site_xpos[site]
            below = float(place[2]) + self.robot.shoe_thickness - (lowest if level else float(points[:, 2].min()))
            below_text = f"the foot reaches {1e3 * below:.1f} mm below the shoe's inner face"
            if below > _BELOW:
                at = (self.robot.sole_origins[side] - below * to_body[:, 2]).round(4).tolist()
                below_text += f"; allowed: {1e3 * _BELOW:g}; origin{key} = {at} works" if level else "; turn it first"
            elif below < -0.25 * self.body.sole_width:
                below_text = f"the shoe hangs {-1e3 * below:.0f} mm below the foot"
            holds = -0.25 * self.body.sole_width <= below <= _BELOW
            found.append(
                Finding(f"under the {side} foot", round(1e3 * below, 2), 1e3 * _BELOW, "mm", holds, below_text)
            )
            if level:
                flat = points[points[:, 2] <= lowest + _BAND][:, :2] - place[:2]
                found.append(self._beside(side, flat, to_body, key))
        return found

    def _beside(self, side: Side, foot: Any, to_body: Any, key: str) -> Finding:
        shoe = np.array(self.robot.layouts[side].outline)[:, :2]
        most = _BESIDE * self.body.sole_width
        off = min(_beyond(foot, shoe), _beyond(shoe, foot))
        middle = 0.5 * (np.ptp(foot, axis=0) - np.ptp(shoe, axis=0)) + foot.min(axis=0) - shoe.min(axis=0)
        text = f"the foot reaches {1e3 * off:.1f} mm beyond the shoe, which reaches as far on another side"
        if min(_beyond(-foot, shoe), _beyond(shoe, -foot)) <= most:
            ways = f"rotation{key} = {roll_pitch_yaw(to_body @ np.diag([-1.0, -1.0, 1.0]))} works"
        elif min(_beyond(foot - middle, shoe), _beyond(shoe, foot - middle)) <= most:
            moved = (self.robot.sole_origins[side] + to_body[:, :2] @ middle).round(4).tolist()
            ways = f"origin{key} = {moved} works"
        else:
            ways = f"turn it by rotation{key} about the sole's normal"
        text = f"{text}; allowed: {1e3 * most:.1f}; {ways}" if off > most else "the shoe lies under the foot"
        return Finding(f"beside the {side} foot", round(1e3 * off, 1), round(1e3 * most, 1), "mm", off <= most, text)

    def _torques(self, reach: PlanReach) -> list[Finding]:
        limits = np.array(self.robot.effort_limits or (self.robot.biped.effort_limits if self.robot.biped else ()))
        if not len(limits):
            return [
                Finding(
                    *("torque", float(reach.carrying.max()), math.inf, "N m", True),
                    text="the robot's file gives no effort_limits: not checked",
                )
            ]
        lean = self.walked.lean
        other = plan_reach(self.robot, self.legs, replace(self.walked, lean=0.0 if lean else self.robot.trunk_lean))
        upright, leaning = (other, reach) if lean else (reach, other)
        found = []
        for name, now, asked in (("upright", upright, not lean), ("leaning", leaning, bool(lean))):
            share = now.carrying / limits
            j = int(share.argmax())
            holds = bool(share[j] <= _HIGHEST) or not asked
            text = f"{self.names[j]} needs {now.carrying[j]:.3g} N m of {limits[j]:.3g} to carry the robot on one leg"
            if not asked:
                text += " (not in this scene)"
            if not holds:
                text += f", {100.0 * (share[j] - _HIGHEST):.0f} % too much; {self._relief(now, other, limits, j, name)}"
            elif share[j] > HELD and asked:
                text += f": more than {100.0 * HELD:.0f} % leaves little to balance with"
            found.append(
                Finding(f"torque {name}", round(float(now.carrying[j]), 3), float(limits[j]), "N m", holds, text)
            )
        moving = reach.torque / limits
        m = int(moving.argmax())
        most = _ROCKING if self.robot.rocks else _MOVING
        fits = bool(moving[m] <= most)
        text = f"{self.names[m]} needs {reach.torque[m]:.3g} N m of {limits[m]:.3g} with what moving takes" + _unless(
            fits, f"; allowed: {100.0 * most:.0f} % for moments; longer single_support or lower com_height helps"
        )
        found.append(Finding("torque moving", round(float(reach.torque[m]), 3), float(limits[m]), "N m", fits, text))
        return found

    def _speed(self, reach: PlanReach) -> list[Finding]:
        share = speed_shares(self.robot, reach)
        j = int(share.argmax())
        if share[j] == 0.0:
            return []
        limit = float(reach.speed[j] / share[j])
        holds = bool(share[j] <= _HURRIED)
        text = f"{self.names[j]} turns by up to {reach.speed[j]:.3g} rad/s" + _unless(
            holds,
            f"; allowed: {_HURRIED:g} x {limit:.3g}, {SPEED_SHARE:g} of its limit; longer single_support helps",
        )
        return [Finding("speed", round(float(reach.speed[j]), 3), round(limit, 3), "rad/s", holds, text)]

    def _relief(self, now: PlanReach, other: PlanReach, limits: Any, joint: int, name: str) -> str:
        if other.carrying[joint] <= limits[joint]:
            return "walk.lean = true works" if name == "upright" else "walk.lean = false works"
        for higher in (0.03, 0.06, 0.1):
            height = self.walked.com_height + higher * self.body.leg
            found = plan_reach(self.robot, self.legs, replace(self.walked, com_height=height))
            if found.missed <= _MISSED and found.knee >= _BENT and found.carrying[joint] <= limits[joint]:
                return f"com_height = {self.robot.com_height + higher * self.body.leg:.3f} works"
        needed = min(now.carrying[joint], other.carrying[joint]) / HELD
        return f"no other height or lean needs less than the limit; a motor of {needed:.3g} N m works"


def _beyond(points: Any, shape: Any) -> float:
    sides = ConvexHull(shape).equations
    return float((points @ sides[:, :2].T + sides[:, 2]).max())


def _unless(holds: bool, remedy: str) -> str:
    return "" if holds else remedy


def _foot_parts(model: Any, name: str, site: str) -> set[int]:
    foot = model.body(name).id
    shoe = int(model.site(site).bodyid[0])
    top = int(model.body_weldid[foot])
    return {b for b in range(model.nbody) if int(model.body_weldid[b]) == top and b != shoe}
