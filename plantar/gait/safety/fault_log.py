"""What was measured and commanded before each fault, kept in memory until it is asked for."""

import os
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, Sensors
from plantar.layouts.layout import SoleLayout
from plantar.recordings.foxglove import log_message
from plantar.recordings.recorder import Recorder
from plantar.sensing.reading import Reading

_BEFORE = 2.0  # s that are kept before a fault
_MOST = 16  # faults that are kept with what came before them; of later ones the text is kept
_MOST_TEXTS = 1000


class Fault(NamedTuple):
    """A fault, at a `time` in s since the first tick, in words."""

    time: float
    text: str


class _Row(NamedTuple):
    time: float
    joints: NDArray[np.float64]
    gyro: NDArray[np.float64]
    accelerometer: NDArray[np.float64]
    readings: Mapping[Side, Reading]
    command: Command


class FaultLog:
    """Keeps the last 2 s before each fault.

    Args:
        period: Of control in s.
        layouts: Of each side.

    Attributes:
        faults: So far, in order.
    """

    def __init__(self, period: float, layouts: Mapping[Side, SoleLayout]) -> None:
        self._period = period
        self._layouts = layouts
        self._rows: deque[_Row] = deque(maxlen=max(1, round(_BEFORE / period)))
        self._kept: dict[float, _Row] = {}
        self._snapshots = 0
        self._ticks = 0
        self.faults: list[Fault] = []

    @property
    def time(self) -> float:
        """Time in s since the first tick, by ticks."""
        return self._ticks * self._period

    def add(self, sensors: Sensors, command: Command) -> None:
        """Keep a tick; what is no array, as of `sensors` that are None, is left out."""
        self._ticks += 1
        try:
            row = _Row(
                self._ticks * self._period,
                sensors.joint_positions.copy(),
                sensors.gyro.copy(),
                sensors.accelerometer.copy(),
                sensors.readings,
                command,
            )
        except AttributeError:
            return
        self._rows.append(row)

    def note(self, text: str) -> None:
        """Keep a fault in words, with the ticks before it."""
        if len(self.faults) >= _MOST_TEXTS:
            return
        self.faults.append(Fault(self.time, text))
        if self._snapshots < _MOST:
            self._snapshots += 1
            self._kept.update({row.time: row for row in self._rows})

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write an MCAP recording of the faults (`/log`) and what came before: `/skin`, `/joints`, `/imu`, `/command`.

        Raises:
            RecordingError: If it cannot be written.
        """
        rows = [self._kept[time] for time in sorted(self._kept)]
        count = len(rows[-1].joints) if rows else 1
        sizes = {side: len(self._layouts[side]) for side in SIDES}
        about: dict[str, object] = {"faults": [[round(fault.time, 4), fault.text] for fault in self.faults]}
        with Recorder(Path(path), about, {side: self._layouts[side] for side in SIDES}) as recorder:
            skins = {side: recorder.channel(f"/skin/{side}", [("force", sizes[side])]) for side in SIDES}
            joints = recorder.channel("/joints", [("position", count)])
            imu = recorder.channel("/imu", [("gyro", 3), ("accelerometer", 3)])
            targets = [("com", 3), ("left", 3), ("right", 3), ("stiffness", 1), ("phase", 1), ("step", 1)]
            command = recorder.channel("/command", targets)
            log = recorder.message_channel("/log", "foxglove.Log")
            for fault in self.faults:
                log.write(fault.time, log_message(fault.time, fault.text, "warning"))
            for row in rows:
                joints.write(row.time, _sized(row.joints, count))
                imu.write(row.time, _sized(row.gyro, 3), _sized(row.accelerometer, 3))
                for side, channel in skins.items():
                    channel.write(row.time, _force(row.readings, side, sizes[side]))
                given = row.command
                feet = (given.feet[side].position for side in SIDES)
                command.write(row.time, given.com, *feet, given.stiffness, given.phase.kind, given.phase.step)


def _force(readings: object, side: Side, size: int) -> NDArray[np.float64]:
    reading = readings.get(side) if isinstance(readings, Mapping) else None
    return _sized(getattr(reading, "force", None), size)


def _sized(values: object, size: int) -> NDArray[np.float64]:
    """Numbers (size,); NaN where there are others or another number."""
    if isinstance(values, np.ndarray) and values.shape == (size,):
        return values.astype(np.float64)
    return np.full(size, np.nan)
