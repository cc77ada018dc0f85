"""Ankle force-torque sensor: the ground's wrench on the sole, less foot and shoe weight."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.lip import GRAVITY


@dataclass(frozen=True)
class SoleWrench:
    """Ground wrench on a sole, with a percept's interface.

    `wrench_in_sole` (6,) about the sole's origin in N and N m, by the world on the robot.
    """

    wrench_in_sole: NDArray[np.float64]

    @property
    def vertical_force(self) -> float:
        """Force along the sole's z axis in N."""
        return float(self.wrench_in_sole[2])

    @property
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Center of pressure (2,), sole frame, in m (T 4.5-4.6); None without load."""
        _, _, fz, tx, ty, _ = self.wrench_in_sole.tolist()
        return np.array([-ty / fz, tx / fz]) if fz > 0.0 else None


@dataclass(frozen=True)
class AnkleSensor:
    """Ankle force-torque sensor and what hangs below it.

    `position`: sensor origin (3,), sole frame, in m; `rotation`: sensor to sole (3, 3); `mass`: foot and shoe below the
    sensor in kg; `com`: their CoM (3,), sole frame, in m.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    mass: float
    com: NDArray[np.float64]

    def sole_wrench(self, measured: NDArray[np.float64], rotation_sole_to_world: NDArray[np.float64]) -> SoleWrench:
        """Returns the ground's wrench (6,) on the sole, without the foot's weight.

        Of `measured` (6,), sensor frame, about its origin in N and N m, by the foot on the leg;
        `rotation_sole_to_world` (3, 3) is the estimated one.
        """
        force = self.rotation.dot(measured[:3])
        lift = (self.mass * GRAVITY) * rotation_sole_to_world[2]  # what carries the weight, in the sole frame
        # Written out: `np.cross` is slow on single vectors, and this runs at every tick.
        fx, fy, fz = force.tolist()
        gx, gy, gz = lift.tolist()
        px, py, pz = self.position.tolist()
        cx, cy, cz = self.com.tolist()
        tx, ty, tz = self.rotation.dot(measured[3:]).tolist()
        return SoleWrench(
            np.array(
                [
                    fx + gx,
                    fy + gy,
                    fz + gz,
                    tx + py * fz - pz * fy + cy * gz - cz * gy,
                    ty + pz * fx - px * fz + cz * gx - cx * gz,
                    tz + px * fy - py * fx + cx * gy - cy * gx,
                ]
            )
        )
