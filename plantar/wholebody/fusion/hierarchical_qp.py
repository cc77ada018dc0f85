"""`fusion.hierarchy` as level-wise least squares within torque, speed and position limits.

Each level is met as limits and higher levels allow (Escande et al. 2014), in mass-weighted coordinates: without limits,
the hierarchy's motion. Infeasible speed and position limits are widened least, then torque's, and the output is cut to
them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.mechanics.within_limits import Box, nearest_within
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.fusion.hierarchy import DAMPED, RANK, Fused, fuse, joint_torques
from plantar.wholebody.fusion.null_space import mass_factor
from plantar.wholebody.tasks.task import Demand


@dataclass(frozen=True)
class JointLimits:
    """Joint limits, in `RobotDynamics.joints` order.

    Attributes:
        torque: Largest (k,) in N m or N.
        velocity: Largest (k,) in rad/s or m/s.
        low: Lowest (k,) in rad or m; -inf for none.
        high: Highest (k,).
        slow_down: Least time in s to a position limit.
        reach: Time in s to bring back excess speed: some control periods.
        acceleration: Every joint's largest in rad/s^2 or m/s^2.
    """

    torque: NDArray[np.float64]
    velocity: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    slow_down: float = 0.1
    reach: float = 0.02
    acceleration: float = np.inf

    def __post_init__(self) -> None:
        smallest = min(np.min(self.torque), np.min(self.velocity), self.slow_down, self.reach, self.acceleration)
        if not smallest > 0.0 or not (np.asarray(self.low) < self.high).all():
            raise InputError(f"a limit of torque, speed or time is {smallest:g}, or a range of positions is empty")

    def accelerations(self, robot: RobotDynamics) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest acceleration (k,) by speed and position limits."""
        position = robot.joint_positions
        speed = robot.velocity[robot.joints]
        slowest = np.maximum(-self.velocity, (self.low - position) / self.slow_down)
        fastest = np.minimum(self.velocity, (self.high - position) / self.slow_down)
        most = self.acceleration
        return np.clip((slowest - speed) / self.reach, -most, most), np.clip(
            (fastest - speed) / self.reach, -most, most
        )


class HierarchicalQP:
    """Fusion, called as `plantar.wholebody.fusion.hierarchy.fuse`.

    `shortcut`: whether to use the hierarchy's motion if within limits: same result, much faster. Attributes `limited`:
    whether a limit acted last.
    """

    def __init__(self, limits: JointLimits, shortcut: bool = True) -> None:
        self.limits = limits
        self.shortcut = shortcut
        self.limited = False

    def __call__(
        self,
        robot: RobotDynamics,
        levels: Sequence[Sequence[Demand | None]],
        support: Demand | None = None,
        external: NDArray[np.float64] | None = None,
    ) -> Fused:
        """Torques, acceleration, support force; arguments as `plantar.wholebody.fusion.hierarchy.fuse`."""
        low, high = self.limits.accelerations(robot)
        if self.shortcut:
            free = fuse(robot, levels, support, external)
            moved = free.acceleration[robot.joints]
            self.limited = not bool((np.abs(free.torque) <= self.limits.torque).all()) or not bool(
                ((low <= moved) & (moved <= high)).all()
            )
            if not self.limited:
                return free
        factor = mass_factor(robot.mass_matrix)
        outer = np.zeros_like(robot.bias) if external is None else external
        still = joint_torques(robot, robot.bias - outer, support)[0]
        columns = factor[robot.joints]  # torque of each y
        if support is not None and len(robot.joints) < len(factor):
            base = np.delete(np.arange(len(factor)), robot.joints)
            shared = np.linalg.lstsq(support.jacobian[:, base].T, factor[base], rcond=None)[0]
            columns = columns - support.jacobian[:, robot.joints].T @ shared
        inverse = np.asarray(
            np.linalg.inv(factor), dtype=float
        )  # once: BLAS threads wait for each other in every triangular solve
        moves = inverse.T[robot.joints]
        box = Box.of(columns, -self.limits.torque - still, self.limits.torque - still, moves, low, high)
        y = _descend(inverse, box, levels, support)
        acceleration = y @ inverse
        torque, force = joint_torques(robot, factor @ y + robot.bias - outer, support)
        return Fused(np.clip(torque, -self.limits.torque, self.limits.torque), acceleration, force)


def _sublevels(
    levels: Sequence[Sequence[Demand | None]], support: Demand | None
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64] | None, NDArray[np.float64] | None]]:
    # Rows met together, with their acceleration or generalized force.
    for level in ([support], *levels):
        meant = [d for d in level if d is not None and d.acceleration is not None]
        pushing = [d for d in level if d is not None and d.acceleration is None and d.force is not None]
        if meant:
            wanted = [a if d.drift is None else a - d.drift for d in meant if (a := d.acceleration) is not None]
            yield np.vstack([d.jacobian for d in meant]), np.concatenate(wanted), None
        if pushing:
            forces = [d.jacobian.T @ d.force for d in pushing if d.force is not None]
            yield np.vstack([d.jacobian for d in pushing]), None, np.sum(forces, axis=0)


def _descend(
    inverse: NDArray[np.float64], box: Box, levels: Sequence[Sequence[Demand | None]], support: Demand | None
) -> NDArray[np.float64]:
    # Meet levels in order, the support unlimited; the rest moves least.
    # and an orthonormal basis of what is left
    y = np.zeros(len(inverse))
    left = np.eye(len(inverse))
    limited = support is None
    for jacobian, wanted, force in _sublevels(levels, support):
        rows = jacobian @ inverse.T
        sizes = np.sqrt(np.einsum("ij,ij->i", rows, rows))
        counted = sizes > RANK * sizes.max()
        if not counted.any() or not left.shape[1]:
            continue
        across, strengths, along = np.linalg.svd(rows[counted] @ left)
        rank = int(np.count_nonzero(strengths > RANK * sizes.max()))
        if rank == 0:
            continue
        own = along[:rank]
        strengths = strengths[:rank]
        weights = np.ones(rank)
        if wanted is not None:
            lengths = np.linalg.norm(jacobian[counted], axis=1)
            damped = DAMPED * float((sizes[counted] / lengths).min() * np.linalg.norm(jacobian, axis=1).max())
            weights = strengths**2 + np.maximum(0.0, 1.0 - (strengths / damped) ** 2) * (damped / 2.0) ** 2
            target = strengths / weights * (across.T[:rank] @ (wanted - rows @ y)[counted])
        else:
            target = own @ (left.T @ (inverse @ np.asarray(force, dtype=float)))
        if limited:
            box, target = nearest_within(box, y, left, own, target, weights)
        limited = True
        y = y + left @ (target @ own)
        left = left @ along[rank:].T
    rest = left.shape[1]
    return y + left @ nearest_within(box, y, left, np.eye(rest), np.zeros(rest), np.ones(rest))[1] if rest else y
