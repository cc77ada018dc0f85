"""Common part of interactions with skin: a force along z of every active taxel, summed by link (T 3.14-3.24)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.sensing.link_skin import BodySkin, LinkWrench, SkinReading, link_wrenches
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task, wrench_demand

__all__ = [
    "DirectInteraction",
    "PressureInteraction",
    "ProximityInteraction",
    "SkinInteraction",
    "TemperatureInteraction",
]


class SkinInteraction(Task):
    """Yields to forces on taxels: tau = sum J^T E w over the links that have an active one (T 3.22-3.24).

    Args:
        patches: Names of the patches that count; all if None; an InputError for an unknown one.

    Attributes:
        counted: Mask (N,) of the taxels that count.
        damping: Damping (2,) of each link that yields: of its origin in N s/m and of its turning in N m s/rad; none by
            default. The owner of a link's motion has to damp it.
    """

    def __init__(self, skin: BodySkin, patches: Sequence[str] | None = None) -> None:
        self.skin = skin
        self.counted = skin.taxels_of(patches)
        self.damping = (0.0, 0.0)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Force (N,) along each taxel's z in N, and the active taxels (N,), without NaN."""
        raise NotImplementedError

    def wrenches(self, skin: SkinReading) -> list[LinkWrench]:
        """Wrench of each link that has an active taxel, about its origin in its frame (T 3.18)."""
        return link_wrenches(self.skin, *self.signal(skin))

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        found = None if skin is None else wrench_demand(robot, self.wrenches(skin))
        if found is None or found.force is None or self.damping == (0.0, 0.0):
            return found
        speeds = (found.jacobian @ robot.velocity).reshape(-1, 2, 3)
        return found._replace(force=found.force - (speeds * np.array(self.damping)[:, None]).ravel())


class DirectInteraction(SkinInteraction):
    """Yields to gain times the force on every taxel at its threshold or above (T 3.23).

    Args:
        gain: Factor on the measured force; 1 acts as on a robot without friction or gears.
        patches: Names of the patches that count; all if None.
    """

    def __init__(self, skin: BodySkin, gain: float = 1.0, patches: Sequence[str] | None = None) -> None:
        super().__init__(skin, patches)
        self.gain = gain
        self._thresholds = np.where(self.counted, skin.thresholds, np.inf)
        own = np.flatnonzero(self.counted)
        self._span = slice(own[0], own[-1] + 1) if len(own) else slice(0)

    def demand(self, robot: RobotDynamics, skin: SkinReading | None) -> Demand | None:
        if skin is None or not (skin.force[self._span] >= self._thresholds[self._span]).any():
            return None  # before anything else: most of a body is not touched
        return super().demand(robot, skin)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        return self.gain * skin.force, skin.force >= self._thresholds


class PressureInteraction(DirectInteraction):
    """Yields to w_P = xi / (sum of active areas) w_f on each link (T 3.27).

    Args:
        sensitivity: xi in m^2: the area with unchanged force.
        patches: Names of the patches that count; all if None.
    """

    def __init__(self, skin: BodySkin, sensitivity: float, patches: Sequence[str] | None = None) -> None:
        super().__init__(skin, patches=patches)
        self.sensitivity = sensitivity

    def wrenches(self, skin: SkinReading) -> list[LinkWrench]:
        """The amplified wrench w_P of each touched link, in its frame (T 3.26-3.27)."""
        found = super().wrenches(skin)
        areas = [float(self.skin.areas[w.taxels].sum()) for w in found]
        return [w._replace(wrench=self.sensitivity / a * w.wrench) for w, a in zip(found, areas, strict=True)]


class ProximityInteraction(SkinInteraction):
    """Yields to f_i = k (d_range - d_i) of every taxel in range (T 3.30 corrected: along +z, into the body).

    Args:
        stiffness: k_prox of one taxel in N/m.
        sensing_range: d_range in m, at most the patches' own; theirs if None. May be changed at any time.
        patches: Names of the patches that count; all if None.

    Raises:
        InputError: If a patch is unknown, or the range is not above 0.
    """

    def __init__(
        self,
        skin: BodySkin,
        stiffness: float,
        sensing_range: float | None = None,
        patches: Sequence[str] | None = None,
    ) -> None:
        if sensing_range is not None and not sensing_range > 0.0:
            raise InputError(f"sensing range is {sensing_range} m; allowed: above 0")
        super().__init__(skin, patches)
        self.stiffness = stiffness
        self.sensing_range = np.inf if sensing_range is None else sensing_range
        self._ranges = np.where(self.counted, skin.ranges, 0.0)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        depth = np.minimum(self._ranges, self.sensing_range) - np.maximum(skin.distance, 0.0)
        return self.stiffness * depth, depth > 0.0


class TemperatureInteraction(SkinInteraction):
    """Yields to kappa_i = gain (T_i - kappa_0) of every taxel at its threshold or above (T 3.34-3.35).

    Args:
        gain: Force of one taxel in N a kelvin above the threshold.
        threshold: kappa_0 in degC.
        patches: Names of the patches that count; all if None.
    """

    def __init__(
        self, skin: BodySkin, gain: float, threshold: float = 31.0, patches: Sequence[str] | None = None
    ) -> None:
        super().__init__(skin, patches)
        self.gain = gain
        self._thresholds = np.where(self.counted, threshold, np.inf)

    def signal(self, skin: SkinReading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        if skin.temperature is None:
            return self._thresholds, np.zeros(len(self.skin), dtype=bool)
        above = skin.temperature - self._thresholds
        return self.gain * above, above >= 0.0
