"""Skin interactions: force along z of active taxels, summed by link (T 3.14-3.24)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.sensing.link_skin import BodySkin, LinkWrench, link_wrenches
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.task import Demand, Task, wrench_demand


class SkinInteraction(Task):
    """Yields to taxel forces: tau = sum J^T E w over links with active ones (T 3.22-3.24, 3.28, 3.33, 3.38).

    `patches`: names that count; None for all; InputError if unknown.

    Attributes:
        counted: Mask (N,) of counting taxels.
        damping: (2,) of each yielding link: origin in N s/m, turning in N m s/rad; none by default. A link's motion
            owner has to damp it.
    """

    def __init__(self, skin: BodySkin, patches: Sequence[str] | None = None) -> None:
        self.skin = skin
        self.counted = skin.taxels_of(patches)
        self.damping = (0.0, 0.0)

    def signal(self, skin: Reading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Force (N,) along taxels' z in N, and active taxels (N,), without NaN."""
        raise NotImplementedError

    def wrenches(self, skin: Reading) -> list[LinkWrench]:
        """Wrench of each link with active taxels, about its origin, own frame (T 3.18)."""
        return link_wrenches(self.skin, *self.signal(skin))

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        found = None if skin is None else wrench_demand(robot, self.wrenches(skin))
        if found is None or found.force is None or self.damping == (0.0, 0.0):
            return found
        speeds = (found.jacobian @ robot.velocity).reshape(-1, 2, 3)
        return found._replace(force=found.force - (speeds * np.array(self.damping)[:, None]).ravel())


class DirectInteraction(SkinInteraction):
    """Yields to gain times force of taxels at threshold (T 3.23).

    Args:
        gain: On the measured force; 1 acts as without friction or gears.
        patches: Names that count; None for all.
    """

    def __init__(self, skin: BodySkin, gain: float = 1.0, patches: Sequence[str] | None = None) -> None:
        super().__init__(skin, patches)
        self.gain = gain
        self._thresholds = np.where(self.counted, skin.thresholds, np.inf)
        own = np.flatnonzero(self.counted)
        self._span = slice(own[0], own[-1] + 1) if len(own) else slice(0)

    def demand(self, robot: RobotDynamics, skin: Reading | None) -> Demand | None:
        if skin is None or not (skin.force[self._span] >= self._thresholds[self._span]).any():
            return None  # before anything else: most of a body is not touched
        return super().demand(robot, skin)

    def signal(self, skin: Reading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        return self.gain * skin.force, skin.force >= self._thresholds


class PressureInteraction(DirectInteraction):
    """Yields to w_P = xi / (sum of active areas) w_f on each link (T 3.27).

    `sensitivity`: xi in m^2: area of unchanged force; `patches`: names that count; None for all.
    """

    def __init__(self, skin: BodySkin, sensitivity: float, patches: Sequence[str] | None = None) -> None:
        super().__init__(skin, patches=patches)
        self.sensitivity = sensitivity

    def wrenches(self, skin: Reading) -> list[LinkWrench]:
        """Amplified wrench w_P of each touched link, own frame (T 3.26-3.27)."""
        found = super().wrenches(skin)
        areas = [float(self.skin.areas[w.taxels].sum()) for w in found]
        return [w._replace(wrench=self.sensitivity / a * w.wrench) for w, a in zip(found, areas, strict=True)]


class ProximityInteraction(SkinInteraction):
    """Yields to f_i = k (d_range - d_i) of taxels in range (T 3.30 corrected: along +z, into the body).

    Args:
        stiffness: A taxel's k_prox in N/m.
        sensing_range: d_range in m, at most the patches'; None for theirs. Changeable at any time.
        patches: Names that count; None for all.
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

    def signal(self, skin: Reading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        depth = np.minimum(self._ranges, self.sensing_range) - np.maximum(skin.distance, 0.0)
        return self.stiffness * depth, depth > 0.0


class TemperatureInteraction(SkinInteraction):
    """Yields to kappa_i = gain (T_i - kappa_0) of taxels at threshold (T 3.34-3.37).

    `gain`: a taxel's N per kelvin above threshold; `threshold`: kappa_0 in degC; `patches`: names that count; None for
    all.
    """

    def __init__(
        self, skin: BodySkin, gain: float, threshold: float = 31.0, patches: Sequence[str] | None = None
    ) -> None:
        super().__init__(skin, patches)
        self.gain = gain
        self._thresholds = np.where(self.counted, threshold, np.inf)

    def signal(self, skin: Reading) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        if skin.temperature is None:
            return self._thresholds, np.zeros(len(self.skin), dtype=bool)
        above = skin.temperature - self._thresholds
        return self.gain * above, above >= 0.0
