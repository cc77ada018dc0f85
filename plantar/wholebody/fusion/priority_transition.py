"""Smooth priority changes between two arrangements' torques (T 3.45-3.46).

In T 3.46, chi = (1 - tanh(delta_t (t - t_t))) / 2 jumps by a half at trigger t_t. Here t_t is mid-change, and chi
scaled from 1 to 0.
"""

import math

import numpy as np
from numpy.typing import NDArray

# delta_t of T 3.46 times half of the duration: tanh of it is 0.96, so little has to be stretched.
STEEPNESS = 2.0


def smooth_share(elapsed: float, duration: float) -> float:
    """1 - chi of T 3.46 (corrected): sigmoid, 0 until the trigger, 1 from the end.

    `elapsed`: since the trigger in s; `duration` of the change in s; 0 jumps. Returns new one's share, 0 to 1.

    Example:
        >>> [round(smooth_share(t, 0.2), 3) for t in (-1.0, 0.0, 0.05, 0.1, 0.2)]
        [0.0, 0.0, 0.105, 0.5, 1.0]
    """
    if elapsed <= 0.0 or duration <= 0.0:
        return float(elapsed > 0.0 or (elapsed == 0.0 and duration <= 0.0))
    if elapsed >= duration:
        return 1.0
    middle = STEEPNESS * (2.0 * elapsed / duration - 1.0)
    return 0.5 * (1.0 + math.tanh(middle) / math.tanh(STEEPNESS))


class PriorityTransition:
    """Blends torques in priority changes; continuous even for overlapping ones.

    `duration` from trigger to the new arrangement alone in s; 0 jumps.
    """

    def __init__(self, duration: float = 0.2) -> None:
        self.duration = duration
        self._last: NDArray[np.float64] | None = None
        self._held: NDArray[np.float64] | None = None
        self._began = -math.inf

    def begin(self, time: float) -> None:
        """Trigger a change at a time in s: the last output is held and fades (tau_(k-1) of T 3.45)."""
        if self._last is not None:
            self._held = self._last
            self._began = time

    def blend(self, torque: NDArray[np.float64], time: float) -> NDArray[np.float64]:
        """tau = chi tau_(k-1) + (1 - chi) tau_k (T 3.45).

        `torque`: current arrangement's (k,) in N m or N; `time` in s. Returns output (k,): the argument itself without
        a change.
        """
        share = smooth_share(time - self._began, self.duration)
        if self._held is None or share >= 1.0:
            self._held = None
            self._last = torque
        else:
            self._last = (1.0 - share) * self._held + share * torque
        return self._last
