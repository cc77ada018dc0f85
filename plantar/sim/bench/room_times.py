"""Share of each room of the program in a run's time."""

import signal
import sys
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from types import FrameType
from typing import Any, Self

from plantar.errors import InputError

_ROOT = Path(__file__).resolve().parents[2]
_INTERVAL = 0.001  # s between two looks: about one a physics step, and under 0.5 % of the time

ROOMS: Mapping[str, tuple[str, ...]] = {
    "physics": (),  # `step_physics` and `Simulation.advance`, whose kernel makes the steps, by their functions' names
    "sensing": ("sim/sensing/", "sim/body_skin/", "sim/plant/"),
    "perception": ("percepts/", "sensing/", "gait/estimate/skin_load.py"),
    "estimate": ("gait/estimate/",),
    "contact": ("gait/contact/",),
    "plan": ("gait/plan/", "gait/propose/"),
    "balance": ("gait/balance/",),
    "feet": ("gait/feet/",),
    "controller": ("gait/",),
    "IK": ("robots/kinematics/inverse_kinematics.py", "robots/kinematics/tasks/", "sim/run/servos.py"),
    "judge": ("sim/judging/",),
    "recording": ("sim/run/log.py", "sim/figures/", "recordings/"),
    "loop": ("sim/run/",),
}
"""Files of each room. A file counts for the first room that names it; what rooms share, such as rotations, kernels
and the legs' kinematics, counts for who called it."""


def room_of(path: str) -> str | None:
    """Name in `ROOMS` of a file's path in `plantar`, or None.

    Example:
        >>> room_of("gait/estimate/skin_load.py"), room_of("gait/estimate/estimator.py"), room_of("lazy.py")
        ('perception', 'estimate', None)
    """
    return next((room for room, parts in ROOMS.items() if path.startswith(parts)), None)


class RoomTimes:
    """Samples the present room a thousand times a second; for the main thread.

    A timer signal counts the innermost function of a room; other languages count for their caller.
    """

    def __init__(self) -> None:
        if not hasattr(signal, "setitimer"):
            raise InputError(f"the time by room cannot be measured on {sys.platform}; allowed: Linux, macOS")
        self._counts: Counter[str] = Counter()
        self._rooms: dict[str, str | None] = {}

    def __enter__(self) -> Self:
        self._before = signal.signal(signal.SIGALRM, self._look)
        signal.setitimer(signal.ITIMER_REAL, _INTERVAL, _INTERVAL)
        return self

    def __exit__(self, *error: Any) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, self._before)

    def _look(self, _number: int, frame: FrameType | None) -> None:
        while frame is not None:
            code = frame.f_code
            if code.co_name == "step_physics":
                self._counts["physics"] += 1
                return
            name = code.co_filename
            if name not in self._rooms:
                path = Path(name)
                inside = path.is_absolute() and path.is_relative_to(_ROOT)
                self._rooms[name] = room_of(path.relative_to(_ROOT).as_posix()) if inside else None
            room = self._rooms[name]
            if room == "loop" and code.co_name == "advance":
                room = "physics"
            if room is not None:
                self._counts[room] += 1
                return
            frame = frame.f_back

    @property
    def shares(self) -> dict[str, float]:
        """Shares of time, ordered as `ROOMS`; empty without a sample."""
        total = sum(self._counts.values())
        return {room: self._counts[room] / total for room in ROOMS} if total else {}
