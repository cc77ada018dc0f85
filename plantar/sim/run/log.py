"""The topics of a run's MCAP file."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.gait.controller import Command, Sensors
from plantar.gait.plan.walk_plan import PlanView
from plantar.layouts.layout import Side
from plantar.recordings.recorder import Recorder
from plantar.sensing.reading import Reading
from plantar.sim.figures.drawn_run import DrawnRun
from plantar.sim.model.contact_truth import GroundTruth
from plantar.sim.model.world import World
from plantar.sim.partner.guide import Guide
from plantar.sim.partner.mobile_robot import MobileRobot
from plantar.sim.partner.touch import Touch

if TYPE_CHECKING:
    from plantar.sim.arms.compliant_arm import CompliantArm

MOST_VERTICES = 24
"""Vertices of a recorded support polygon; of a rounder one those are left out that change its area least."""


class RunLog(ExitStack):
    """Writes a run's recording; a context manager.

    `world`: the world; `zmps`: whether to record skin and ankle ZMPs; `touch`: partners and their skin, or None; `arm`:
    the moving arm, or None.
    """

    def __init__(
        self,
        path: Path,
        world: World,
        metadata: Mapping[str, object],
        *,
        zmps: bool = False,
        touch: Touch | None = None,
        arm: "CompliantArm | None" = None,
    ) -> None:
        super().__init__()
        k = len(world.servos)
        self._world = world
        recorder = self.enter_context(Recorder(path, metadata, {s: world.robot.layouts[s] for s in SIDES}))
        channel = recorder.channel
        self._skin = {s: channel(f"/skin/{s}", [("force", len(world.robot.layouts[s]))]) for s in SIDES}
        self._proximity = {s: channel(f"/proximity/{s}", [("distance", len(world.robot.layouts[s]))]) for s in SIDES}
        self._joints = channel("/joints", [("position", k), ("command", k), ("torque", k)])
        self._estimate = channel("/estimate", [("com", 3), ("com_velocity", 3), ("dcm", 2), ("zmp", 2)])
        self._reference = channel(
            "/reference", [("com", 3), ("dcm", 2), ("zmp", 2), ("zmp_desired", 2), ("phase", 1), ("step", 1)]
        )
        self._truth = {
            s: channel(f"/truth/{s}", [("normal_force", 1), ("position", 3), ("rotation", 9)]) for s in SIDES
        }
        self._body = channel("/truth/body", [("com", 3), ("zmp", 2), ("zmp_margin", 1), ("rotation", 9), ("wrench", 6)])
        self._foothold = channel(
            "/foothold", [("step", 1), ("side", 1), ("area_ratio", 1), ("vrp", 2), ("polygon", 2 * MOST_VERTICES)]
        )
        self._zmps = channel("/zmp", [("skin", 2), ("force_torque", 2)]) if zmps else None
        self._touch = touch
        self._partner = None
        if touch is not None:
            self._touched = channel("/touch", [("force", 3), ("felt", 3)])
            self._feet = channel("/feet", [(side, 3) for side in SIDES])
            self._partner = next((p for p in touch.partners if isinstance(p, MobileRobot)), None)
        if self._partner is not None:
            self._partners = channel("/partner", [("moved", 1), ("reference", 1), ("force", 1)])
        self._arm = arm
        if arm is not None:
            joints = len(arm.posture)
            self._arms = channel("/arm", [("position", joints), ("posture", joints), ("torque", joints)])
        self._guide = None if touch is None else next((p for p in touch.partners if isinstance(p, Guide)), None)
        if self._guide is not None:
            self._guides = channel("/guide", [("place", 3), ("held", 3), ("reference", 1), ("moved", 1), ("force", 1)])
        self._drawn = DrawnRun(recorder, world)

    def skin(self, readings: Mapping[Side, Reading]) -> None:
        """Record the soles' latest readings at their sample times."""
        for side, channel in self._skin.items():
            channel.write(readings[side].time, readings[side].force)
        for side, near in self._proximity.items():
            distance = readings[side].proximity
            if distance is not None:
                near.write(readings[side].time, distance)
        self._drawn.skin(readings)

    def zmps(self, time: float, skin: NDArray[np.float64] | None, force_torque: NDArray[np.float64] | None) -> None:
        """Record filtered ZMPs (2,) in m of `skin` and ankles (`force_torque`) at `time` in s; NaN for none."""
        if self._zmps is not None:
            self._zmps.write(time, _or_nan(skin), _or_nan(force_torque))

    def _footholds(self, time: float, command: Command) -> None:
        for found in command.footholds:
            ring = _with_fewer_vertices(found.polygon).ravel()
            polygon = np.full(2 * MOST_VERTICES, np.nan)
            polygon[: len(ring)] = ring
            self._foothold.write(time, found.step, SIDES.index(found.side), found.area_ratio, found.vrp, polygon)

    def note(self, time: float, text: str, level: str = "info") -> None:
        """Record a `text` with a `level` ("info", "warning" or "error") at `time` in s."""
        self._drawn.log(time, text, level)

    def tick(
        self,
        sensors: Sensors,
        command: Command,
        plan: PlanView,
        joints: NDArray[np.float64],
        truth: GroundTruth,
        loads: Sequence[float],
    ) -> None:
        """Record one control tick, after its physics step.

        `joints`: references (k,) in rad; `loads`: vertical in N on left and right foot.
        """
        w = self._world
        time = sensors.time
        data = w.data
        state = command.state
        reference = command.reference
        self._joints.write(time, sensors.joint_positions, joints, data.actuator_force[w.servos])
        self._estimate.write(time, state.com, state.com_velocity, command.dcm, _or_nan(state.zmp))
        planned = command.com, reference.dcm, reference.vrp, command.zmp_desired
        self._reference.write(time, *planned, command.phase.kind, command.phase.step)
        for load, (side, channel) in zip(loads, self._truth.items(), strict=True):
            site = w.sole_sites[side]
            channel.write(time, load, data.site_xpos[site], data.site_xmat[site])
        balance = data.subtree_com[w.torso], _or_nan(truth.zmp), _or_nan(truth.margin)
        self._body.write(time, *balance, data.xmat[w.torso], truth.wrench)
        if command.footholds:
            self._footholds(time, command)
        self._drawn.tick(time, command, plan, truth, loads)
        if self._touch is not None:
            self._record_touch(self._touch, sensors, command)
        if self._arm is not None:
            self._arms.write(time, self._arm.true_angles, self._arm.posture, self._arm.torque)
        if self._guide is not None:
            guide = self._guide
            along = (guide.sign * guide.reference, guide.sign * guide.moved, guide.sign * guide.force)
            self._guides.write(time, guide.position(w), guide.held(w)[0], *along)

    def _record_touch(self, touch: Touch, sensors: Sensors, command: Command) -> None:
        measured = np.full(3, np.nan)
        if sensors.skin is not None:
            skin = touch.sensor.body_skin
            world = self._world
            active = sensors.skin.force >= skin.thresholds
            measured = np.zeros(3)
            for patch in skin.patches:
                own = np.flatnonzero(active[skin.slices[patch.name]]) + skin.slices[patch.name].start
                turn = world.data.body(patch.link).xmat.reshape(3, 3)
                measured += turn @ (sensors.skin.force[own] @ skin.normals[own])
        self._touched.write(sensors.time, touch.force, measured)
        self._feet.write(sensors.time, *(command.feet[side].position for side in SIDES))
        if self._partner is not None:
            self._partners.write(sensors.time, self._partner.moved, self._partner.law.position, self._partner.force)


def _with_fewer_vertices(ring: NDArray[np.float64]) -> NDArray[np.float64]:
    """A polygon (k, 2) of at most `MOST_VERTICES`: again and again without the one whose triangle with its neighbours
    is smallest (Visvalingam and Whyatt 1993).
    """
    while len(ring) > MOST_VERTICES:
        before = ring - np.roll(ring, 1, axis=0)
        after = np.roll(ring, -1, axis=0) - ring
        doubled = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
        ring = np.delete(ring, int(doubled.argmin()), axis=0)
    return ring


def _or_nan(value: Any) -> Any:
    return np.nan if value is None else value
