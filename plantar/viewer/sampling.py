"""Messages reduced to the latest at given times, while reading in pieces."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.viewer.messages import transform_template, transforms


class Latest:
    """Keeps for each wanted time the last value until it; else the first.

    `times`: wanted (n,) in s, ascending; `keep`: called with a row slice and value; `reach`: farthest time in s from a
    value's own. Attributes `late`: values left out for later ones before them.

    Example:
        >>> rows = np.empty(3)
        >>> latest = Latest(np.array([0.0, 1.0, 2.0]), rows.__setitem__)
        >>> for time, value in ((0.5, 7.0), (1.5, 8.0)):
        ...     latest.take(time, lambda value=value: value)
        >>> latest.finish(), rows.tolist()
        (None, [7.0, 7.0, 8.0])
    """

    def __init__(self, times: NDArray[np.float64], keep: Callable[[slice, Any], None], reach: float = np.inf) -> None:
        self._times = times
        self._keep = keep
        self._reach = reach
        self._row = 0
        self._held: Callable[[], Any] | None = None
        self._since = -np.inf
        self.count = 0
        self.late = 0

    def take(self, time: float, value: Callable[[], Any]) -> None:
        """Take a value at a time in s; value is called where kept."""
        if time < self._since:
            self.late += 1
            return
        self._fill(int(np.searchsorted(self._times, time - 1e-9)))
        self._held = value
        self._since = time
        self.count += 1

    def held(self) -> Any:
        """Value taken last."""
        return None if self._held is None else self._held()

    def finish(self) -> None:
        """Let the last value hold to the end."""
        self._fill(len(self._times))

    def _fill(self, end: int) -> None:
        if self._held is not None and end > self._row:
            first, last = np.searchsorted(self._times, (self._since - self._reach, self._since + self._reach))
            if (begin := max(self._row, int(first))) < min(end, int(last)):
                self._keep(slice(begin, min(end, int(last))), self._held())
            self._row = end


class FramePoses:
    """Frame poses at wanted times (n,) in s, from foxglove.FrameTransforms; frames missing in a message stay.

    `poses` (n, k, 7): position in m and quaternion (x, y, z, w).
    """

    def __init__(self, first: bytes, names: list[str], times: NDArray[np.float64]) -> None:
        self.poses = np.empty((len(times), len(names), 7))
        self.latest = Latest(times, self.poses.__setitem__)
        self._rows = {name: i for i, name in enumerate(names)}
        self._start = np.tile([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (len(names), 1))
        self._template = transform_template(first) if [name for name, _, _ in transforms(first)] == names else None

    def take(self, time: float, message: bytes) -> None:
        """Take a message of a time in s; ValueError if damaged."""
        template = self._template
        if template is not None and template.matches(message):
            self.latest.take(time, lambda: template.values_of([message]).reshape(-1, 7))
            return
        now = np.array(self.latest.held() if self.latest.count else self._start)
        for name, _, pose in transforms(message):
            if name in self._rows:
                now[self._rows[name]] = pose
        self.latest.take(time, lambda: now)
