"""A robot's tasks in order, and their torques."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinReading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.hierarchy import Fused, fuse
from plantar.wholebody.tasks.task import Demand, Task

__all__ = ["Fusion", "TaskStack"]


class Fusion(Protocol):
    """Makes one torque of many demands, as `plantar.wholebody.fusion.hierarchy.fuse`."""

    def __call__(
        self,
        robot: RobotDynamics,
        levels: Sequence[Sequence[Demand | None]],
        support: Demand | None = None,
        external: NDArray[np.float64] | None = None,
    ) -> Fused:
        """See `plantar.wholebody.fusion.hierarchy.fuse`."""


class TaskStack:
    """Tasks by priority.

    Args:
        levels: Tasks of each level, the highest priority first. May be assigned at any time.
        support: Task of the support, above all levels; None for a fixed base.
        fusion: How demands are fused.

    Attributes:
        silent: Number of skipped tasks, those without a demand, so far.
    """

    def __init__(self, levels: Sequence[Sequence[Task]], support: Task | None = None, fusion: Fusion = fuse) -> None:
        self.levels = [list(level) for level in levels]
        self.support = support
        self.fusion = fusion
        self.silent = 0

    def step(
        self, robot: RobotDynamics, skin: SkinReading | None = None, external: NDArray[np.float64] | None = None
    ) -> Fused:
        """Ask every task, and fuse.

        Args:
            robot: Kinematics and dynamics of this instant.
            skin: The latest reading of the skin.
            external: Known generalized force (n,); None for none.

        Returns:
            Torques, acceleration and support force.
        """
        demands = [[task.demand(robot, skin) for task in level] for level in self.levels]
        self.silent += sum(demand is None for level in demands for demand in level)
        support = None if self.support is None else self.support.demand(robot, skin)
        return self.fusion(robot, demands, support, external)
