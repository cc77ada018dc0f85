"""Limits of a command for any reading of the sensors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.gait.command import Command
from plantar.settings.body_scale import BodyScale
from plantar.sides import SIDES

__all__ = ["CommandCheck"]

_FASTEST = 12.0  # leg/beat of a foot's or the CoM's target, a step a beat long ten times over: beyond it, it jumps
_FARTHEST = 3.0  # leg from the middle between the feet to the CoM's target: it cannot be meant
_LIFTED = 0.02  # leg that a target may jump by at once: where a foot touches down its target is where it is


class CommandCheck:
    """Checks each command of a run with a control `period` in s."""

    def __init__(self, body: BodyScale, period: float) -> None:
        self._body = body
        self._step = _FASTEST * body.leg / body.beat * period + _LIFTED * body.leg
        self._last: list[NDArray[np.float64]] | None = None

    def fault(self, command: Command, joints: NDArray[np.float64]) -> str | None:
        """Returns what is wrong with a `command` and the `joints` (k,) in rad that follow, in words, or None."""
        feet = [command.feet[side] for side in SIDES]
        every = {
            "CoM": command.com,
            "torso": command.rotation_torso,
            "desired ZMP": command.zmp_desired,
            "joints": joints,
            **{f"{side} sole": foot.position for side, foot in zip(SIDES, feet, strict=True)},
            **{f"{side} sole's rotation": foot.rotation for side, foot in zip(SIDES, feet, strict=True)},
            **{f"{side} sole's force": foot.force for side, foot in zip(SIDES, feet, strict=True)},
            **{f"{side} centre of pressure": foot.center_of_pressure for side, foot in zip(SIDES, feet, strict=True)},
        }
        if command.joint_offsets is not None:
            every["joint offsets"] = command.joint_offsets
        for name, values in every.items():
            if not np.isfinite(values).all():
                return f"not finite: {name}"
        targets = [command.com, *(foot.position for foot in feet)]
        last, self._last = self._last, targets
        middle = 0.5 * (feet[0].position + feet[1].position)
        if float(np.linalg.norm(command.com - middle)) > _FARTHEST * self._body.leg:
            return "out of bounds: CoM is nowhere near the feet"
        if last is not None:
            for name, now, before in zip(("CoM", "left sole", "right sole"), targets, last, strict=True):
                way = float(np.linalg.norm(now - before))
                if way > self._step:
                    return f"jump: {name} by {way:.3g} m in a tick"
        for name, rotation in (("torso", command.rotation_torso), *zip(SIDES, (f.rotation for f in feet), strict=True)):
            if float(np.abs(rotation @ rotation.T - np.eye(3)).max()) > 1e-6:
                return f"out of bounds: {name} is turned by no rotation"
        return None
