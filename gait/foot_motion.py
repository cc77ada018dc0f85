"""Where the feet are commanded to be: footholds that stand, a foot that swings, and how it lands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gait.command_frame import CommandFrame
from gait.footsteps import Footstep, other_side
from gait.phases import Phase, WalkSchedule
from gait.swing import SwingTrajectory
from plantar.layout import Side

__all__ = ["FootMotion", "Landing"]

_SIDES: tuple[Side, Side] = ("left", "right")


@dataclass(frozen=True)
class Landing:
    """How a foot lands.

    Attributes:
        contact_force: Vertical force in N on the swing foot that counts as touchdown (the papers' 70 N).
        press_force: Vertical force in N up to which a foot that has touched is pressed down.
        depth: Depth in m below the expected ground that the swing aims for, so that the foot rests on it with some
            tens of newtons and does not hover.
        speed: Speed in m/s at which a foot that met no ground yet goes on downwards.
        acceleration: Its acceleration in m/s^2.
        reach: Distance in m that it goes down at most.
    """

    contact_force: float = 70.0
    press_force: float = 200.0
    depth: float = 0.0004
    speed: float = 0.03
    acceleration: float = 1.0
    reach: float = 0.03


class FootMotion:
    """Commanded footholds over time.

    Args:
        feet: Where the feet stand at the start.
        schedule: The footsteps with their phases.
        period: Control period in s.
        swing_height: Clearance of the swing foot in m.
        landing: How a foot lands.
    """

    def __init__(
        self,
        feet: Mapping[Side, Footstep],
        schedule: WalkSchedule,
        period: float,
        swing_height: float,
        landing: Landing,
    ) -> None:
        self.schedule = schedule
        self.footholds: dict[Side, tuple[NDArray[np.float64], float]] = {
            s: (feet[s].position.copy(), feet[s].yaw) for s in _SIDES
        }
        self.landed = True
        self._period = period
        self._height = swing_height
        self._landing = landing
        self._swing: SwingTrajectory | None = None
        self._step = -1
        self._lowered = self._lowering = 0.0

    @property
    def last_side(self) -> Side | None:
        """The foot that swings or swung last; None before the first step."""
        return None if self._swing is None else self.schedule.steps[self._step].side

    @property
    def proximity_sides(self) -> tuple[Side, ...]:
        """Feet whose proximity the motion depends on: none, without preemptive compliance."""
        return ()

    def rotation(self, side: Side) -> NDArray[np.float64]:
        """Rotation (3, 3) from a level sole at its foothold to the command frame."""
        return Footstep(side, 0.0, 0.0, self.footholds[side][1]).rotation_sole_to_world

    def update(self, phase: Phase, time: float, loads: Mapping[Side, float], frame: CommandFrame) -> bool:
        """Advance the swing foot; stop it at touchdown, lower it further while it has met no ground or bounced off.

        Args:
            phase: Phase of the walk.
            time: Time in s.
            loads: Vertical force on each foot in N.
            frame: Frame that the footholds are commanded in.

        Returns:
            Whether a new swing began.
        """
        began = phase.swing is not None and self._step != phase.step
        if phase.swing is not None and began:
            self._begin(phase, phase.swing, frame)
        if self._swing is None:
            return began
        side = self.schedule.steps[self._step].side
        if phase.swing is not None:
            elapsed = time - phase.start
            if elapsed > 0.5 * self._swing.duration and loads[side] > self._landing.contact_force:
                self.landed = True
            if not self.landed:
                self.footholds[side] = self._swing.at(elapsed)
                return began
        self.landed = True  # it touched, or the plan puts weight on it now
        self._press(side, loads[side])
        return began

    def _begin(self, phase: Phase, side: Side, frame: CommandFrame) -> None:
        step = self.schedule.steps[phase.step]
        position, yaw = self.footholds[side]
        ground = self.footholds[other_side(side)][0][2]
        target = np.array([*frame.to_command(step.position[:2]), ground - self._landing.depth])
        duration = phase.end - phase.start
        self._swing = SwingTrajectory(position.copy(), target, yaw, step.yaw - frame.turn, self._height, duration)
        self._step = phase.step
        self.landed = False
        self._lowered = self._lowering = 0.0

    def _press(self, side: Side, load: float) -> None:
        """Press down the more gently the more the foot carries; a switch at one force would make it tap."""
        landing = self._landing
        missing = 1.0 - load / landing.press_force
        wanted = landing.speed * missing if missing > 0.0 and self._lowered < landing.reach else 0.0
        self._lowering = min(wanted, self._lowering + landing.acceleration * self._period)
        if self._lowering > 0.0:
            drop = self._lowering * self._period
            self._lowered += drop
            position, yaw = self.footholds[side]
            self.footholds[side] = (position - np.array([0.0, 0.0, drop]), yaw)
