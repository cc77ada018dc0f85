"""The interface to a model of the robot at one instant."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["RobotDynamics"]


class RobotDynamics(Protocol):
    """The equations of motion M q'' + bias = S^T tau + J^T f (T 3.1, 3.12, A 1) and the kinematics of links.

    Jacobians map the generalized velocity (n,) to the world frame. Joints are the actuated velocity coordinates, in the
    model's order.

    Attributes:
        time: Time in s.
        velocity: Generalized velocity (n,).
        mass_matrix: M (n, n), symmetric and positive definite.
        bias: C(q, q') q' + g (n,).
        joints: Indices (k,) of the actuated coordinates among the n, selected by S; all with a fixed base.
        joint_positions: Position (k,) of each of them in rad or m.
    """

    @property
    def time(self) -> float: ...

    @property
    def velocity(self) -> NDArray[np.float64]: ...

    @property
    def mass_matrix(self) -> NDArray[np.float64]: ...

    @property
    def bias(self) -> NDArray[np.float64]: ...

    @property
    def joints(self) -> NDArray[np.int64]: ...

    @property
    def joint_positions(self) -> NDArray[np.float64]: ...

    def pose(self, link: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Origin (3,) of a link's frame in the world in m and rotation (3, 3) to the world; an InputError without the
        link.
        """

    def jacobian(self, link: str, point: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Geometric Jacobian (6, n) of a point fixed to a link, linear rows first, in the world frame.

        Args:
            link: Name of the link; an InputError if unknown.
            point: Point (3,) in the link's frame in m; its origin if None.

        Returns:
            The Jacobian.
        """

    def drift(self, link: str, point: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """J' q' (6,) of a `link` and `point` as in `jacobian`: acceleration while q'' = 0. Returns it in m/s^2 and
        rad/s^2.
        """

    def com(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Center of mass: position (3,) in m, Jacobian (3, n) and drift (3,) in m/s^2."""
