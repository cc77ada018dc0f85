"""Pushes on the base, in a step or standing."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.errors import SceneError
from plantar.gait.plan.phases import WalkSchedule
from plantar.mechanics.same_time import SAME_TIME
from plantar.sim.model.shove import Shove
from plantar.sim.model.world import World
from plantar.sim.run.scene import Push

_DIRECTIONS = {
    "forward": (1.0, 0.0),
    "backward": (-1.0, 0.0),
    "left": (0.0, 1.0),
    "right": (0.0, -1.0),
}
_FIRST = 1.5  # s: a robot that stands is left alone for so long
_WEAKEST = 0.6  # of the scene's impulse: the weakest of several seeded pushes


class Pusher:
    """Applies pushes to the torso.

    Attributes `step` of the push, or None; `pushing`: whether a push acts now; `applied`: impulse (3,) in N s of each
    begun push.

    Args:
        seed: In a step: seeds 0-3 push forward, backward, left and right, and so on; the step is drawn. Standing: draws
            directions, and strengths of 0.6 to 1 of the impulse.
    """

    def __init__(self, push: Push, schedule: WalkSchedule, seed: int) -> None:
        _refuse_unused(push)
        self.direction = direction_name(push, seed)
        self.step: int | None = None
        self.shoves: tuple[Shove, ...] = ()
        self.applied: list[NDArray[np.float64]] = []
        self._next = 0
        self.pushing = False
        self._height = push.height
        self._torso = -1
        self._wrench = np.zeros(6)
        if push.strength <= 0.0:
            return
        rng = np.random.default_rng([seed, 0xB0])
        if push.count:
            self.shoves = _while_standing(push, schedule, rng)
            return
        swings = [p for p in schedule.phases if p.swing is not None]
        if not swings or push.step >= len(swings):
            raise SceneError(f"[push] step is {push.step}; the walk has {len(swings)} steps, counted from 0")
        self.step = int(rng.integers(len(swings))) if push.step < 0 else push.step
        phase = swings[self.step]
        start = phase.start + push.phase * (phase.end - phase.start)
        impulse = push.strength * np.array([*direction_of(push, seed), 0.0])
        self.shoves = (Shove(start, start + push.duration, impulse, smooth=False),)

    def free_steps(self, world: World, most: int) -> int:
        """How many of the next physics steps, `most` at most, no push acts in; 0 while one does, or is about to."""
        if self.pushing:
            return 0
        if self._next >= len(self.shoves):
            return most
        left = (self.shoves[self._next].start - world.data.time) / world.period
        return max(0, min(most, int(left) - 1))

    def apply(self, world: World) -> None:
        """Set the torso's external force for a physics step."""
        if self._next >= len(self.shoves) and not self.pushing:
            return
        time = world.data.time + SAME_TIME
        period = world.period
        force = np.zeros(3)
        self.pushing = False
        while self._next < len(self.shoves) and time + period > self.shoves[self._next].start:
            part = self.shoves[self._next].force(time, period)
            if len(self.applied) == self._next:
                self.applied.append(np.zeros(3))
            self.applied[self._next] += period * part
            force = force + part
            self.pushing = True
            if time + period < self.shoves[self._next].end:
                break
            self._next += 1
        fx, fy, fz = force.tolist()
        self._torso = world.torso
        self._wrench[:] = (fx, fy, fz, -self._height * fy, self._height * fx, 0.0)
        world.data.xfrc_applied[world.torso] = self._wrench

    def add_applied(self, forces: NDArray[np.float64]) -> None:
        """Add what it applies now, as `plantar.sim.judging.outside_force.Actor`."""
        if self.pushing:
            forces[self._torso] += self._wrench

    def largest_impulse(self) -> float:
        """Largest impulse in N s of its pushes so far."""
        return max((float(np.linalg.norm(given)) for given in self.applied), default=0.0)


def direction_name(push: Push, seed: int) -> str:
    """Returns forward, backward, left or right by `seed` of a `push`, or "angle" or "step"."""
    return tuple(_DIRECTIONS)[seed % len(_DIRECTIONS)] if push.direction == "seeded" else push.direction


def direction_of(push: Push, seed: int) -> tuple[float, float]:
    """Returns unit vector (2,), forward and left, of a `push`; `seed` chooses an open one."""
    if push.direction == "angle":
        return math.cos(math.radians(push.angle)), math.sin(math.radians(push.angle))
    return _DIRECTIONS[direction_name(push, seed)]


def _refuse_unused(push: Push) -> None:
    alone = {"direction": push.direction == "step", "cycle": push.cycle >= 0.0, "repeat": push.repeat > 1}
    alone |= {"with_swing": push.with_swing}
    alone |= {"small": push.small > 0.0, "place": push.place != "height"}
    given = [name for name, is_given in alone.items() if is_given]
    if given:
        raise SceneError(f"[push] {given[0]} is for pushes by hands; allowed: with push.by = 'hands'")


def _while_standing(push: Push, schedule: WalkSchedule, rng: np.random.Generator) -> tuple[Shove, ...]:
    if schedule.steps:
        raise SceneError(f"[push] count is {push.count}; allowed: 0 in a walk of {schedule.steps} steps")
    needed = _FIRST + push.count * push.interval
    if push.duration > push.interval or needed > schedule.end:
        raise SceneError(
            f"[push] {push.count} pushes of {push.duration:g} s every {push.interval:g} s need a scene of {needed:g} s "
            f"(walk.settle) and a duration below the interval; the scene ends after {schedule.end:g} s"
        )
    shoves = []
    for i in range(push.count):
        angle = rng.uniform(-math.pi, math.pi)
        strength = rng.uniform(_WEAKEST, 1.0)
        along = np.array([math.cos(angle), push.sideways * math.sin(angle), 0.0])
        if push.direction != "seeded":
            along = np.array([*direction_of(push, 0), 0.0])
            strength = 1.0
        start = _FIRST + i * push.interval
        shoves.append(Shove(start, start + push.duration, strength * push.strength * along, smooth=True))
    return tuple(shoves)
