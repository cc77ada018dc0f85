"""A run for a 3D viewer: Foxglove topics in its recording."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.plan_change import AppliedChange
from plantar.gait.plan.walk_plan import PlanView
from plantar.layouts.layout import SoleLayout
from plantar.mujoco.quaternions import quaternion_of
from plantar.recordings.foxglove import (
    Message,
    Template,
    arrow,
    cylinder,
    delete_all,
    entity,
    frame_transform,
    line_loop,
    log_message,
    pose,
    slot,
    sphere,
    words,
)
from plantar.recordings.recorder import Recorder
from plantar.sensing.reading import Reading
from plantar.sim.figures.drawn_shapes import body_entity, drawn_bodies, frame_name
from plantar.sim.model.contact_truth import GroundTruth
from plantar.sim.model.world import World

_FRAMES = 0.02  # s between two messages of where bodies are
_SOLES = 0.04  # s between two readings of the soles and of the balance
_CORNERS = 12  # of a support polygon that is drawn; it seldom has more
# of a taxel's cell, and m: how wide and how thick it is drawn
_CELL = 0.92
_THICK = 2e-3
_ARROW = 0.5  # leg: length of the arrow for the robot's weight
# footsteps that are drawn before and after the current one
_BEHIND = 4
_AHEAD = 12
_VIRIDIS = [[0.27, 0.0, 0.33], [0.23, 0.32, 0.55], [0.13, 0.57, 0.55], [0.37, 0.79, 0.38], [0.99, 0.91, 0.14]]
_SIDE_COLOURS = {"left": (0.12, 0.42, 0.75, 1.0), "right": (0.80, 0.33, 0.10, 1.0)}
_FORCE = (0.85, 0.1, 0.3, 1.0)
_ZMP = (0.85, 0.1, 0.3)
_COM = (0.95, 0.6, 0.1, 1.0)
_POLYGON = (0.1, 0.55, 0.3, 1.0)


FULL_COLOUR = 0.1
"""Share of the weight on a taxel that has the last colour: twice what it has of a foot that carries all."""


def scale_colours(largest: float) -> NDArray[np.float64]:
    """Viridis (64, 3) from zero force to FULL_COLOUR; `largest` is the full value."""
    shares = np.linspace(0.0, 1.0, 64)
    steps = np.linspace(0.0, 1.0, len(_VIRIDIS))
    return largest * np.column_stack([np.interp(shares, steps, column) for column in zip(*_VIRIDIS, strict=True)])


class DrawnRun:
    """Writes viewer topics of a `world` to a `recorder`.

    "/tf" has poses of bodies, soles and CoM, "/scene/world" shapes, "/scene/soles" forces, "/scene/balance" CoM, ZMP
    and support polygon, "/scene/footsteps" the plan, "/log" its changes.
    """

    def __init__(self, recorder: Recorder, world: World) -> None:
        self._world = world
        self._latest: Mapping[Side, Reading] = {}
        self._bodies = drawn_bodies(world.model)
        self._next_frame = -math.inf
        self._next_soles = -math.inf
        self._step: int | None = None
        self._change: AppliedChange | None = None
        self._layouts = world.robot.layouts
        self._drawn_steps: dict[tuple[int, Footstep], Message] = {}
        self._full = FULL_COLOUR * world.body.weight
        self._metres = _ARROW * world.body.leg / world.body.weight
        self._colours = scale_colours(1.0)
        self._unit = 0.02 * world.body.leg  # diameter of the ball at a point
        frames = self._frames_template()
        soles = Template(*(part for i, s in enumerate(SIDES) for part in self._sole(s, i)))
        scene = "foxglove.SceneUpdate"
        self._tf = recorder.template_channel("/tf", "foxglove.FrameTransforms", frames)
        self._shapes = recorder.message_channel("/scene/world", scene)
        self._soles = recorder.template_channel("/scene/soles", scene, soles, self._sole_values)
        self._balance = recorder.template_channel("/scene/balance", scene, self._balance_template())
        self._steps = recorder.message_channel("/scene/footsteps", scene)
        self._log = recorder.message_channel("/log", "foxglove.Log")

    def skin(self, readings: Mapping[Side, Reading]) -> None:
        """Take the soles' latest readings."""
        self._latest = readings

    def tick(self, time: float, command: Command, plan: PlanView, truth: GroundTruth, loads: Sequence[float]) -> None:
        """Draw the tick at `time` in s, if due: `command`, `plan`, `truth`, both feet's vertical `loads` in N."""
        if self._next_frame == -math.inf:
            self._draw_shapes(time)
        if time >= self._next_frame:
            self._next_frame = time + _FRAMES - 1e-6
            self._tf.write(time, self._frame_values())
        if time >= self._next_soles and self._latest:
            self._next_soles = time + _SOLES - 1e-6
            self._soles.write(time, np.concatenate([self._latest[side].force for side in SIDES]))
            self._balance.write(time, self._balance_values(truth, loads))
        changed = plan.last is not self._change
        if changed and plan.last is not None:
            self._log.write(time, log_message(time, change_text(plan.last), name="plan"))
        self._change = plan.last
        if changed or command.phase.step != self._step:
            self._step = command.phase.step
            self._steps.write(time, self._footsteps(plan, self._step).filled(time))

    def log(self, time: float, text: str, level: str = "info") -> None:
        """Log a `text` at `time` in s with `level` "info", "warning" or "error"."""
        self._log.write(time, log_message(time, text, level))

    def _draw_shapes(self, time: float) -> None:
        model = self._world.model
        entities = [body_entity(model, body) for body in (0, *self._bodies)]
        self._shapes.write(time, Template(*entities).filled(time))

    def _frames_template(self) -> Template:
        names = [frame_name(self._world.model, body) for body in self._bodies]
        names += [*(f"sole_{side}" for side in SIDES), "center_of_mass"]
        slots = ([slot(7 * i + j) for j in range(7)] for i in range(len(names)))
        return Template(*(frame_transform(name, s[:3], s[3:]) for name, s in zip(names, slots, strict=True)))

    def _frame_values(self) -> NDArray[np.float64]:
        """Flat position and quaternion (x, y, z, w) of bodies, soles and CoM."""
        data = self._world.data
        n = len(self._bodies)
        out = np.zeros((n + 3, 7))
        out[-1, :3] = data.subtree_com[self._world.torso]
        out[-1, 6] = 1.0
        out[:n, :3] = data.xpos[self._bodies]
        out[:n, 3:] = data.xquat[self._bodies][:, [1, 2, 3, 0]]
        for i, side in enumerate(SIDES, n):
            site = self._world.sole_sites[side]
            out[i, :3] = data.site_xpos[site]
            out[i, 3:] = quaternion_of(data.site_xmat[site])[[1, 2, 3, 0]]
        return out.ravel()

    def _sole(self, side: Side, number: int) -> list[Message]:
        """Entities of a sole in its own frame: taxels, CoP and force.

        Slots: three a taxel, left sole first, then four a sole's force.
        """
        layout = self._layouts[side]
        first = 3 * len(self._layouts["left"]) * number
        last = 3 * sum(len(self._layouts[s]) for s in SIDES) + 4 * number
        x, y, length, shown = (slot(last + j) for j in range(4))
        upwards = (0.0, -math.sqrt(0.5), 0.0, math.sqrt(0.5))  # turns the arrow's x axis to the sole's z axis
        ball = (1.5 * self._unit,) * 3
        force = arrow(pose((x, y, 0.0), upwards), length, 0.6 * self._unit, (*_FORCE[:3], shown))
        cop = sphere(pose((x, y, 0.0)), ball, (*_FORCE[:3], shown))
        frame = f"sole_{side}"
        return [
            entity(f"taxels {side}", frame, *_taxels(layout, first)),
            entity(f"CoP {side}", frame, cop, force),
        ]

    def _sole_values(self, rows: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values (m, k) of `_sole`'s slots by forces (m, n) of both soles in N."""
        forces = np.nan_to_num(rows)
        places = np.clip(forces / self._full * len(self._colours), 0, len(self._colours) - 1).astype(np.intp)
        values = [self._colours[places].reshape(len(rows), -1)]
        split = np.split(forces, [len(self._layouts["left"])], axis=1)
        for side, force in zip(SIDES, split, strict=True):
            total = force.sum(axis=1, keepdims=True).clip(min=0.0)
            cop = force @ self._layouts[side].positions[:, :2] / np.where(total > 0.0, total, np.inf)
            values.append(np.hstack([cop, total * self._metres, total > 0.0]))
        return np.hstack(values)

    def _balance_template(self) -> Template:
        """Slots: 0 to 2 CoM, 3 to 6 ZMP and opacity, then corners and opacities."""
        com = sphere(pose([slot(i) for i in range(3)]), (2.0 * self._unit,) * 3, _COM)
        zmp = sphere(pose([slot(i) for i in range(3, 6)]), (1.2 * self._unit,) * 3, (*_ZMP, slot(6)))
        corners = [[slot(7 + 3 * i + j) for j in range(3)] for i in range(_CORNERS)]
        ring = line_loop(corners, 0.3 * self._unit, (*_POLYGON[:3], slot(7 + 3 * _CORNERS)))
        return Template(
            entity("CoM", "world", com, locked=False),
            entity("ZMP", "world", zmp, locked=False),
            entity("support polygon", "world", ring, locked=False),
        )

    def _balance_values(self, truth: GroundTruth, loads: Sequence[float]) -> NDArray[np.float64]:
        world = self._world
        data = world.data
        ground = float(data.site_xpos[world.sole_sites["left" if loads[0] >= loads[1] else "right"], 2])
        out = np.zeros(8 + 3 * _CORNERS)
        out[:3] = data.subtree_com[world.torso]
        if truth.zmp is not None:
            out[3:7] = *truth.zmp, ground, 1.0
        if len(truth.polygon) > 2:
            corners = truth.polygon[np.linspace(0, len(truth.polygon) - 1, _CORNERS).round().astype(int)]
            out[7:-1] = np.column_stack([corners, np.full(_CORNERS, ground)]).ravel()
            out[-1] = 1.0
        return out

    def _footsteps(self, plan: PlanView, step: int) -> Template:
        last = plan.first + len(plan.steps)
        chosen = range(max(plan.first, step - _BEHIND), min(last, step + _AHEAD + 1))
        wanted = [(k, plan.foothold(k)) for k in chosen]
        drawn = self._drawn_steps
        self._drawn_steps = {step: drawn.get(step) or self._footstep(*step) for step in wanted}
        return Template(delete_all(), *self._drawn_steps.values())

    def _footstep(self, number: int, foot: Footstep) -> Message:
        outline = self._layouts[foot.side].outline
        flat = np.column_stack([outline, np.full(len(outline), 0.1 * self._unit)])
        corners = flat @ foot.rotation_sole_to_world.T + foot.position
        colour = _SIDE_COLOURS[foot.side]
        label = words(pose(tuple(foot.position.tolist())), str(number), 1.5 * self._unit, colour)
        ring = line_loop(corners.tolist(), 0.2 * self._unit, colour)
        return entity(f"footstep {number}", "world", ring, label, locked=False)


def _taxels(layout: SoleLayout, first: int) -> list[Message]:
    """A flat cylinder a taxel, with three slots each from `first`."""
    parts = []
    for i, corners in enumerate(layout.corners):
        cell = layout.vertices[list(corners), :2]
        low = cell.min(axis=0)
        high = cell.max(axis=0)
        x, y = (0.5 * (low + high)).tolist()
        a, b = (_CELL * (high - low)).tolist()
        colour = (*(slot(first + 3 * i + j) for j in range(3)), 1.0)
        parts.append(cylinder(pose((x, y, float(layout.positions[i, 2]))), (a, b, _THICK), colour))
    return parts


def change_text(applied: AppliedChange) -> str:
    """A change of the plan in a line: step, reason, change."""
    change = applied.change
    parts = [f"step {change.step}: {change.reason}"]
    known = [moved for moved in applied.moved if moved.before is not None]
    for moved in known[:1]:
        assert moved.before is not None
        by = 1e3 * (moved.x - moved.before.x), 1e3 * (moved.y - moved.before.y)
        parts.append(f"footstep {moved.step} moved by {by[0]:+.0f} mm forward and {by[1]:+.0f} mm to the left")
    if len(known) > 1:
        parts.append(f"{len(known) - 1} more footstep(s) after it")
    if len(applied.moved) > len(known):
        parts.append(f"{len(applied.moved) - len(known)} new footstep(s)")
    if change.vrp is not None:
        parts.append(f"VRP at ({change.vrp[0]:.3f}, {change.vrp[1]:.3f}) m")
    if change.longer:
        parts.append(
            f"single support {'longer' if change.longer > 0.0 else 'shorter'} by {1e3 * abs(change.longer):.0f} ms"
        )
    if applied.delay > 0.0:
        parts.append(f"double support longer by {1e3 * applied.delay:.0f} ms")
    return "; ".join(parts)
