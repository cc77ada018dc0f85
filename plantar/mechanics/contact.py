"""Contacts of a robot with the world, as mappings by name whose order results keep."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.lazy import lazy
from plantar.mechanics.wrench import wrench_in_frame
from plantar.mechanics.wrench_cone import Rectangle


@dataclass(frozen=True)
class Contact:
    """Flat contact. Reuse the object while it does not change: programs keep its data.

    `position`: origin (3,) of contact frame in world in m; `rotation`: rotation (3, 3) from contact to world frame;
    `rectangle`: contact area in contact frame; `friction`: coefficient of friction pyramid, above 0; `preferred`:
    preferred center of pressure (x, y) in contact frame in m; rectangle's middle if None.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    rectangle: Rectangle
    friction: float = 0.6  # nature: rubber on dry concrete has 0.6 to 0.85
    preferred: tuple[float, float] | None = None

    @property
    def limits(self) -> tuple[Rectangle, float, tuple[float, float] | None]:
        """Constraints independent of the pose."""
        return self.rectangle, self.friction, self.preferred

    @lazy
    def center_in_world(self) -> tuple[float, float, float]:
        """Preferred center of pressure in world in m."""
        x, y = self.preferred or self.rectangle.center
        px, py, pz = self.position.tolist()
        dx, dy, dz = self.rotation.dot(np.array((x, y, 0.0))).tolist()
        return px + dx, py + dy, pz + dz

    def wrench_in_world(self, wrench: ArrayLike) -> NDArray[np.float64]:
        """Wrench (..., 6) about the contact frame's origin as about the world's, in N and N m."""
        return wrench_in_frame(wrench, self.rotation, self.position)


Contacts = Mapping[str, Contact]
"""Contacts by name, in order."""
