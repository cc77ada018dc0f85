"""What was measured and commanded before each fault, kept in memory until it is asked for."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, Sensors
from plantar.kernels.safety.tick_ring import TickRing
from plantar.layouts.layout import SoleLayout
from plantar.recordings.foxglove import log_message
from plantar.recordings.recorder import Recorder

_BEFORE = 2.0  # chosen: s that are kept before a fault: a step of the slowest walk; a log alone depends on it
_MOST = 16  # faults that are kept with what came before them; of later ones the text is kept
_MOST_TEXTS = 1000


class Fault(NamedTuple):
    """A fault, at a `time` in s since the first tick, in words."""

    time: float
    text: str


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
        self._most = max(1, round(_BEFORE / period))
        self._ring = TickRing(0, ())
        self._joints = -1
        self._kept: dict[float, NDArray[np.float64]] = {}
        self._snapshots = 0
        self._ticks = 0
        self.faults: list[Fault] = []

    @property
    def time(self) -> float:
        """Time in s since the first tick, by ticks."""
        return self._ticks * self._period

    def add(self, sensors: Sensors, command: Command) -> None:
        """Keep a tick's numbers; what is no array, as of `sensors` that are None, is left out."""
        self._ticks += 1
        try:
            joints = len(sensors.joint_positions)
            if joints != self._joints:
                self._begin(joints)
            self._ring.add_tick(self._ticks * self._period, sensors, command)
        except (AttributeError, TypeError):
            return

    def _begin(self, joints: int) -> None:
        """Forget all ticks, for those of another number of joints."""
        self._joints = joints
        sizes = (len(self._layouts[side]) for side in SIDES)
        self._ring = TickRing(self._most, (joints, 3, 3, *sizes, 3, 3, 3))

    def note(self, text: str) -> None:
        """Keep a fault in words, with the ticks before it."""
        if len(self.faults) >= _MOST_TEXTS:
            return
        self.faults.append(Fault(self.time, text))
        if self._snapshots < _MOST:
            self._snapshots += 1
            self._kept.update({float(row[0]): row for row in self._ring.kept()})

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write an MCAP recording of the faults (`/log`) and what came before: `/skin`, `/joints`, `/imu`, `/command`.

        Raises:
            RecordingError: If it cannot be written.
        """
        rows = [self._kept[time] for time in sorted(self._kept)]
        sizes = {side: len(self._layouts[side]) for side in SIDES}
        about: dict[str, object] = {"faults": [[round(fault.time, 4), fault.text] for fault in self.faults]}
        with Recorder(Path(path), about, {side: self._layouts[side] for side in SIDES}) as recorder:
            skins = {side: recorder.channel(f"/skin/{side}", [("force", sizes[side])]) for side in SIDES}
            joints = recorder.channel("/joints", [("position", max(1, self._joints))])
            imu = recorder.channel("/imu", [("gyro", 3), ("accelerometer", 3)])
            targets = [("com", 3), ("left", 3), ("right", 3), ("stiffness", 1), ("phase", 1), ("step", 1)]
            command = recorder.channel("/command", targets)
            log = recorder.message_channel("/log", "foxglove.Log")
            for fault in self.faults:
                log.write(fault.time, log_message(fault.time, fault.text, "warning"))
            ends = np.cumsum([4, self._joints, 3, 3, *sizes.values(), 3, 3, 3])
            for row in rows:
                if len(row) != ends[-1]:
                    continue  # of another number of joints
                time, stiffness, phase, step = row[:4].tolist()
                angles, gyro, accelerometer, left, right, *places = np.split(row[4:], ends[1:-1] - 4)
                joints.write(time, angles)
                imu.write(time, gyro, accelerometer)
                for channel, force in zip(skins.values(), (left, right), strict=True):
                    channel.write(time, force)
                command.write(time, *places, stiffness, phase, step)
