"""The last ticks' numbers, in memory that is used again and again."""

from collections.abc import Mapping

import numpy as np

from ..base import memory

__all__ = ["TickRing"]

_NONE = float("nan")


class TickRing:
    """Rows of the last ticks, each of a time, three more numbers, and fields of fixed sizes.

    `most`: number of ticks that are kept; `sizes` of the fields.
    """

    def __init__(self, most, sizes):
        self.sizes = tuple(sizes)
        self.width = 4 + sum(self.sizes)
        self.rows = np.full((most, self.width), _NONE)
        self.numbers = self.rows.reshape(-1)
        self.most = most
        self.count = 0

    def add(self, time, first, second, third, fields):
        """Keep a tick's numbers and fields: arrays (size,) each; what is none is kept as NaN."""
        into = (self.count % self.most) * self.width
        self.count += 1
        row = memory.room(self.numbers)
        row[into] = time
        row[into + 1] = first
        row[into + 2] = second
        row[into + 3] = third
        into += 4
        for i in range(len(self.sizes)):
            size = self.sizes[i]
            field = fields[i]
            if memory.size(field) != size:
                field = _numbers(field, size)
            values = memory.values(field)
            for k in range(size):
                row[into + k] = values[k]
            into += size

    def add_tick(self, time, sensors, command):
        """Keep a tick by a controller's `sensors` and `command`: stiffness, kind and step of the phase; encoders, gyro,
        accelerometer, forces of the left and right sole, and targets of the CoM and both soles.
        """
        readings = sensors.readings
        phase = command.phase
        feet = command.feet
        self.add(
            time,
            command.stiffness,
            phase.kind,
            phase.step,
            (
                sensors.joint_positions,
                sensors.gyro,
                sensors.accelerometer,
                _force(readings, "left"),
                _force(readings, "right"),
                command.com,
                feet["left"].position,
                feet["right"].position,
            ),
        )

    def kept(self):
        """Copies of the kept rows (k, 4 + all sizes), oldest first."""
        if self.count <= self.most:
            return self.rows[: self.count].copy()
        return np.roll(self.rows, -(self.count % self.most), axis=0)


def _force(readings, side):
    """Forces of a side's reading as they are; None where there is none."""
    reading = readings.get(side) if isinstance(readings, (dict, Mapping)) else None
    return getattr(reading, "force", None)


def _numbers(field, size):
    """Numbers (size,) of an array of another kind; NaN of anything else."""
    if isinstance(field, np.ndarray) and field.shape == (size,) and field.dtype.kind in "fiub":
        return field.astype(np.float64)
    return np.full(size, _NONE)
