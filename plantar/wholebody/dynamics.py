"""Interface to a robot model at an instant."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray


class RobotDynamics(Protocol):
    """Equations of motion M q'' + bias = S^T tau + J^T f, and link kinematics.

    Jacobians map generalized velocity (n,) to the world. Joints: actuated velocity coordinates, model order.

    `time` in s; `velocity`: generalized (n,); `mass_matrix`: M (n, n), symmetric and positive definite; `bias`: C(q,
    q') q' + g (n,); `joints`: indices (k,) of actuated coordinates (S); all with a fixed base; `joint_positions`:
    theirs (k,) in rad or m.
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
        """A link's origin (3,), world frame, in m and rotation (3, 3) to it; InputError if unknown."""

    def jacobian(self, link: str, point: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Geometric Jacobian (6, n) of a link's point, linear rows first, world frame.

        `link` by name; InputError if unknown; `point` (3,), link frame, in m; None for its origin.
        """

    def drift(self, link: str, point: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns J' q' (6,) of a `link` and `point` (`jacobian`) in m/s^2, rad/s^2: acceleration at q'' = 0."""

    def com(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Center of mass: position (3,) in m, Jacobian (3, n) and drift (3,) in m/s^2."""
