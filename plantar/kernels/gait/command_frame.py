"""Frame in which joints are solved: fixed to commanded footholds, slowly following the carrying foot."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ..base import memory, vectors

__all__ = ["CommandFrame"]


class CommandFrame:
    """Offset and turn of the command frame in the world.

    `anchor`: initial foot position (3,), command frame, in m; `period` of control in s; `time_constant` of following in
    s. Attributes `turn` in rad; `offset` (x, y, z) from world to frame at the anchor, in m.
    """

    def __init__(self, anchor: NDArray[np.float64], period: float, time_constant: float) -> None:
        place = memory.values(anchor)
        self.anchor_x = place[0]
        self.anchor_y = place[1]
        self.anchor_z = place[2]
        self.x = 0.0
        self.y = 0.0
        self.z = 0.0
        self.turn = 0.0
        self.share = min(1.0, period / time_constant)

    def follow(
        self,
        commanded: NDArray[np.float64],
        yaw: float,
        real: NDArray[np.float64],
        rotation: NDArray[np.float64],
    ) -> None:
        """`update` by the carrying sole's commanded heading in rad and its estimated rotation (3, 3) to the world."""
        r = memory.values(rotation)
        self.update(commanded, real, math.remainder(math.atan2(r[3], r[0]) - yaw, 2.0 * math.pi))

    def update(self, commanded: NDArray[np.float64], real: NDArray[np.float64], turn: float) -> None:
        """Follow the carrying foot for a tick: `commanded` and `real`, estimated in the world, (3,) in m, and its
        heading less the commanded one, `turn` in rad.
        """
        share = self.share
        c = memory.values(commanded)
        r = memory.values(real)
        # The anchor moves as slowly as the rest: a jump from foot to foot would turn the CoM about another point.
        self.anchor_x += share * (c[0] - self.anchor_x)
        self.anchor_y += share * (c[1] - self.anchor_y)
        self.anchor_z += share * (c[2] - self.anchor_z)
        self.x += share * (r[0] - c[0] - self.x)
        self.y += share * (r[1] - c[1] - self.y)
        self.z += share * (r[2] - c[2] - self.z)
        self.turn += share * (turn - self.turn)

    @property
    def offset(self) -> tuple[float, float, float]:
        """From world to frame at the anchor, in m."""
        return self.x, self.y, self.z

    def now(self) -> CommandFrame:
        """A copy that later updates do not change."""
        frame = CommandFrame.__new__(CommandFrame)
        frame.anchor_x = self.anchor_x
        frame.anchor_y = self.anchor_y
        frame.anchor_z = self.anchor_z
        frame.x = self.x
        frame.y = self.y
        frame.z = self.z
        frame.turn = self.turn
        frame.share = self.share
        return frame

    def to_command(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A horizontal world point (2,) in the command frame, in m.

        Example:
            >>> CommandFrame(np.zeros(3), 0.005, 0.3).to_command(np.array([1.0, 2.0])).tolist()
            [1.0, 2.0]
        """
        p = memory.values(point)
        dx = p[0] - self.anchor_x - self.x
        dy = p[1] - self.anchor_y - self.y
        # Heights are not turned: the frame turns about the vertical axis alone.
        c = math.cos(self.turn)
        s = math.sin(self.turn)
        return vectors.vector2(self.anchor_x + c * dx + s * dy, self.anchor_y - s * dx + c * dy)

    def to_world(self, point: NDArray[np.float64]) -> NDArray[np.float64]:
        """A command-frame point (3,) in the world, in m."""
        x, y, z = self._in_world(point)
        return vectors.vector(x, y, z)

    def aligned(self, point: NDArray[np.float64], com: NDArray[np.float64]) -> NDArray[np.float64]:
        """A command-frame point (3,) in the world, turned back about the estimated `com` (3,) to the commanded heading,
        in m.
        """
        center = memory.values(com)
        x, y, z = self._in_world(point)
        dx = x - center[0]
        dy = y - center[1]
        c = math.cos(self.turn)
        s = math.sin(self.turn)
        return vectors.vector(center[0] + c * dx + s * dy, center[1] - s * dx + c * dy, z)

    def _in_world(self, point):
        p = memory.values(point)
        dx = p[0] - self.anchor_x
        dy = p[1] - self.anchor_y
        c = math.cos(self.turn)
        s = math.sin(self.turn)
        return (
            self.anchor_x + self.x + (c * dx - s * dy),
            self.anchor_y + self.y + (s * dx + c * dy),
            self.anchor_z + self.z + (p[2] - self.anchor_z),
        )
