"""How a robot stops: hold, sit down, or go limp, by ramps."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command
from plantar.kernels.base.vectors import vector

# measured: leg/beat at which a foot in the air is put down, and the CoM moves; thrice as fast H1 falls
_LOWER = 0.15
_SINK = 0.03  # chosen: a fifth of `_LOWER`: a sitting robot sinks for as long as a step
_DEPTH = 0.08  # chosen: leg by which a robot sits lower than it walks; legs that walk crouched by 0.05 reach it
_SHIFT = 0.3  # chosen: weight/beat by which forces of the feet change
_LIMP = 0.5  # chosen: s in which forces and stiffness of a fallen robot go to zero
_SINKS = 2.0  # chosen: s in which those of a robot do that sits, and may stand

SITS = ("blind", "lost", "stopped")
"""States in which a robot sits down."""


class SafeStop:
    """Commands after a state that stays.

    "sit" levels a foot in the air with the other, brings the CoM over their middle and lowers it; "limp" releases the
    joints.

    `period` of control in s; `leg`: leg length in m; `beat`: body's time unit in s; `weight` in N. Attribute `state`:
    that the last command answered, None before any.
    """

    def __init__(self, period: float, leg: float, beat: float, weight: float) -> None:
        share = period / beat
        self._lower = _LOWER * leg * share
        self._sink = _SINK * leg * share
        self._shift = _SHIFT * weight * share
        self._depth = _DEPTH * leg
        self._limp = {"fallen": period / _LIMP, "released": period / _LIMP, "limp": period / _SINKS}
        self._height: float | None = None
        self.state: str | None = None

    def after(self, last: Command, state: str | None) -> Command:
        """Returns the command after `last` in a `state`: "fallen" and "released" go limp in 0.5 s, "limp" in 2 s, those
        of `SITS` sit, others hold.
        """
        self.state = state
        last = last.changed(footholds=(), moved_steps=())
        if state in self._limp:
            return self._limped(last, self._limp[state])
        return self._seated(last) if state in SITS else last

    def _limped(self, last: Command, by: float) -> Command:
        stiffness = max(0.0, last.stiffness - by)
        share = stiffness / last.stiffness if last.stiffness > 0.0 else 0.0
        forces = {side: share * foot.force for side, foot in last.feet.items()}
        return last.changed(feet={s: last.feet[s].changed(force=forces[s]) for s in SIDES}, stiffness=stiffness)

    def _seated(self, last: Command) -> Command:
        feet = dict(last.feet)
        swing = last.phase.swing
        if swing is not None:
            foot = feet[swing]
            other = feet["left" if swing == "right" else "right"]
            above = foot.position.item(2) - other.position.item(2)
            if above > 0.0:
                drop = vector(0.0, 0.0, min(above, self._lower))
                feet[swing] = foot.changed(position=foot.position - drop)
                if above > self._lower:
                    return last.changed(feet=feet)
        if self._height is None:
            self._height = last.com.item(2) - self._depth
        left = feet["left"].position
        right = feet["right"].position
        goal = 0.5 * (left + right)
        goal[2] = self._height
        com = _nearer(last.com, goal, self._sink)
        across = (left - right)[:2]
        # nature: floating point: no division by 0
        share = float((com - right)[:2] @ across / max(float(across @ across), 1e-9))
        shares: dict[Side, float] = {"left": min(1.0, max(0.0, share)), "right": min(1.0, max(0.0, 1.0 - share))}
        total = sum(foot.force.item(2) for foot in last.feet.values())
        for side in SIDES:
            wanted = np.array([0.0, 0.0, total * shares[side]])
            feet[side] = feet[side].changed(force=_nearer(feet[side].force, wanted, self._shift))
        return last.changed(feet=feet, com=com)


def _nearer(at: NDArray[np.float64], to: NDArray[np.float64], most: float) -> NDArray[np.float64]:
    return at + np.clip(to - at, -most, most)
