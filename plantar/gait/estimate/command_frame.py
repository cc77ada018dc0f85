"""Frame in which joints are solved: fixed to commanded footholds, slowly following the carrying foot."""

import math

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.base.vectors import vector, vector2


class CommandFrame:
    """Offset and turn of the command frame in the world.

    `anchor`: initial foot position (3,), command frame, in m; `period` of control in s; `time_constant` of following in
    s.
    """

    def __init__(self, anchor: NDArray[np.float64], period: float, time_constant: float) -> None:
        # Plain numbers: on three of them an array costs five times as much, and all of this runs at every tick.
        x, y, z = anchor.tolist()
        self._anchor: tuple[float, float, float] = (x, y, z)
        self._offset = (0.0, 0.0, 0.0)
        self.turn = 0.0
        self._share = min(1.0, period / time_constant)

    def update(self, commanded: NDArray[np.float64], real: NDArray[np.float64], turn: float) -> None:
        """Follow the carrying foot for a tick: `commanded` and `real`, estimated in the world, (3,) in m, and its
        heading less the commanded one, `turn` in rad.
        """
        ax, ay, az = self._anchor
        ox, oy, oz = self._offset
        share = self._share
        cx, cy, cz = commanded.tolist()
        rx, ry, rz = real.tolist()
        # The anchor moves as slowly as the rest: a jump from foot to foot would turn the CoM about another point.
        self._anchor = ax + share * (cx - ax), ay + share * (cy - ay), az + share * (cz - az)
        self._offset = ox + share * (rx - cx - ox), oy + share * (ry - cy - oy), oz + share * (rz - cz - oz)
        self.turn += share * (turn - self.turn)

    @property
    def offset(self) -> tuple[float, float, float]:
        """From world to frame at the anchor, in m."""
        return self._offset

    def now(self) -> "CommandFrame":
        """A copy that later updates do not change."""
        frame = object.__new__(CommandFrame)
        frame.__dict__.update(self.__dict__)
        return frame

    def to_command(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A horizontal world point (2,) in the command frame, in m.

        Example:
            >>> CommandFrame(np.zeros(3), 0.005, 0.3).to_command(np.array([1.0, 2.0])).tolist()
            [1.0, 2.0]
        """
        px, py = point.tolist()
        x, y, _ = self._anchor
        ox, oy, _ = self._offset
        dx = px - x - ox
        dy = py - y - oy
        # Heights are not turned: the frame turns about the vertical axis alone.
        c = math.cos(self.turn)
        s = math.sin(self.turn)
        return vector2(x + c * dx + s * dy, y - s * dx + c * dy)

    def to_world(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A command-frame point (3,) in the world, in m."""
        px, py, pz = point.tolist()
        x, y, z = self._anchor
        ox, oy, oz = self._offset
        dx = px - x
        dy = py - y
        c = math.cos(self.turn)
        s = math.sin(self.turn)
        return vector(x + ox + (c * dx - s * dy), y + oy + (s * dx + c * dy), z + oz + (pz - z))
