"""A scene's pushes by hands, and their times."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.errors import SceneError
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase, WalkSchedule
from plantar.robots.robot import Robot
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.body_skin.upper_body import upper_body_skin
from plantar.sim.model.world import World
from plantar.sim.partner.hand_pushes import HandPush, HandPushes, faces_of
from plantar.sim.run.pushing import direction_of
from plantar.sim.run.scene import Push, Scene

_SHOULDER = 0.7  # of the way from the hips to the top of the upper body

Steps = tuple[Mapping[Side, Footstep], Sequence[Footstep]]
"""Where the feet stand at the start, and the footsteps as planned at the start."""


def upper_body_skin_of(
    scene: Scene, robot: Robot, model: Any, body: BodyScale, worn: WornArm | None = None
) -> BodySkin | None:
    """A robot's upper body skin in a scene; None where not touched.

    `worn`: its moving arm with skin, or None. Returns the skin, in frames of base and arm links.
    """
    if scene.guide.way > 0.0 and worn is None:
        raise SceneError("[guide] way is above 0 and arm.side 'none'; allowed: with an arm that moves, left or right")
    patches: list[SkinPatch] = []
    if (scene.push.by == "hands" and scene.push.strength > 0.0) or scene.partner.kind != "none":
        base = int(model.body_rootid[model.body(robot.torso_body).id])
        patches += upper_body_skin(model, base, leg=body.leg, weight=body.weight).patches
    if worn is not None and (patches or scene.guide.way > 0.0):
        patches += worn.skin.patches
    return BodySkin(patches) if patches else None


def hand_pushes(
    push: Push, schedule: Callable[[], WalkSchedule], steps: Steps, skin: BodySkin, body: BodyScale, seed: int
) -> HandPushes:
    """A scene's hands and pushes.

    `schedule`: returns the walk's planned phases; `steps`: standing feet and planned steps at the start.
    """
    made = []
    for first, share in _pushed_steps(push, schedule(), np.random.default_rng([seed, 0xB0])):
        k = _with_swing(steps, first, direction_of(push, seed)) if push.with_swing else first
        along = _along(steps, k) if push.direction == "step" else np.array(direction_of(push, seed))
        made.append(HandPush(share * push.strength * along, push.duration, _When(push, schedule, k), k))
    return HandPushes(made, skin, body, lambda world: pushed_height(push, skin, faces_of(made), world))


def _pushed_steps(push: Push, schedule: WalkSchedule, rng: np.random.Generator) -> list[tuple[int, float]]:
    if push.count:
        raise SceneError("[push] count is for pushes by a force; allowed: 0 with push.by = 'hands'")

    def from_step(first: int) -> list[tuple[int, float]]:
        small = [(first - push.small_before, push.small)] if push.small > 0.0 else []
        return [*small, *((k, 1.0) for k in range(first, first + push.repeat))]

    def possible(first: int) -> bool:
        return all(_moment(push, schedule, k) is not None for k, _ in from_step(first))

    found = [first for first in range(schedule.steps) if possible(first)]
    if not found or (push.step >= 0 and push.step not in found):
        allowed = f"{found[0]} to {found[-1]}" if found else "a longer walk"
        raise SceneError(
            f"[push] step is {push.step} in a walk of {schedule.steps} steps, counted from 0; allowed: {allowed}, so "
            "that it has all steps that are pushed (repeat, small_before), and with push.cycle the two after each"
        )
    return from_step(found[int(rng.integers(len(found)))] if push.step < 0 else push.step)


def _with_swing(steps: Steps, k: int, direction: tuple[float, float]) -> int:
    """Step k, or the next where a push goes to that foot's side."""
    ahead, left = direction
    out = left if steps[1][k].side == "left" else -left
    return k if out >= 0.0 or abs(ahead) > abs(left) or k + 1 >= len(steps[1]) else k + 1


class _When:
    def __init__(self, push: Push, schedule: Callable[[], WalkSchedule], step: int) -> None:
        self._push = push
        self._schedule = schedule
        self._step = step
        self._moment = math.inf  # by the last plan that had the step
        self._of: WalkSchedule | None = None

    def __call__(self) -> float:
        now = self._schedule()
        if now is not self._of:  # plans are values: another object may have other times
            self._of = now
            found = _moment(self._push, now, self._step)
            self._moment = self._moment if found is None else found
        return self._moment


def _moment(push: Push, schedule: WalkSchedule, step: int) -> float | None:
    """When a push in a step begins in s, or None."""
    phase = _single_support(schedule, step)
    if phase is None:
        return None
    if push.cycle < 0.0:
        return phase.start + push.phase * (phase.end - phase.start)
    after = _single_support(schedule, step + 2)
    return None if after is None else phase.start + push.cycle * (after.start - phase.start)


def _single_support(schedule: WalkSchedule, step: int) -> Phase | None:
    return next((p for p in schedule.phases if p.swing is not None and p.step == step), None)


def _along(steps: Steps, k: int) -> NDArray[np.float64]:
    feet, plan = steps
    side = plan[k].side
    before = next((s for s in reversed(plan[:k]) if s.side == side), feet[side])
    way = np.array([plan[k].x - before.x, plan[k].y - before.y])
    length = float(np.hypot(*way))
    return way / length if length > 0.0 else np.array([1.0, 0.0])


def pushed_height(push: Push, skin: BodySkin, faces: Sequence[str], world: World) -> float:
    """Returns the pushed height above the base's origin in m of a robot standing in a `world`.

    Named heights of a `push` move until all palms on `faces` find `skin`.
    """
    model = world.model
    data = world.data
    base = float(data.xpos[model.body_rootid[world.torso], 2])
    if push.place == "height":
        return float(data.xipos[world.torso, 2]) + push.height - base
    levels = [skin.positions[skin.slices[face], 2] for face in faces] or [skin.positions[:, 2]]
    low = max(float(z.min()) for z in levels)
    high = min(float(z.max()) for z in levels)
    joints = [model.joint(world.robot.legs[side].joints[0]).id for side in SIDES]
    hips = float(data.xanchor[joints, 2].mean()) - base
    named = {
        "com": float(data.subtree_com[world.torso, 2]) - base,
        "hip": hips,
        "shoulder": hips + _SHOULDER * (high - hips),
    }
    return min(max(named[push.place], low), high)
