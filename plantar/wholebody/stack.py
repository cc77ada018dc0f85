"""A robot's ordered tasks, and their torques."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.hierarchy import Fused, fuse
from plantar.wholebody.tasks.task import Task

Fusion = Callable[..., Fused]
"""Demands to one torque, called as `plantar.wholebody.fusion.hierarchy.fuse`."""


class TaskStack:
    """Tasks by priority.

    Args:
        levels: Each level's tasks, highest priority first; assignable at any time.
        support: Its task, above all levels; None for a fixed base.
        fusion: Of demands.

    Attributes:
        silent: Skipped tasks, without a demand, so far.
    """

    def __init__(self, levels: Sequence[Sequence[Task]], support: Task | None = None, fusion: Fusion = fuse) -> None:
        self.levels = [list(level) for level in levels]
        self.support = support
        self.fusion = fusion
        self.silent = 0

    def step(
        self, robot: RobotDynamics, skin: Reading | None = None, external: NDArray[np.float64] | None = None
    ) -> Fused:
        """Ask every task for a `robot`'s dynamics now and the latest `skin` reading, and fuse.

        Returns torques, acceleration and support force; `external` is a known generalized force (n,), None for none.
        """
        demands = [[task.demand(robot, skin) for task in level] for level in self.levels]
        self.silent += sum(demand is None for level in demands for demand in level)
        support = None if self.support is None else self.support.demand(robot, skin)
        return self.fusion(robot, demands, support, external)
