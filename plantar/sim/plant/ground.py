"""True ground: friction, softness and colours by place, and foam under soles."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import BodyScale
from plantar.sim.plant.draw import TruePlant, stream
from plantar.sim.terrain import GROUND_CONTACT

PATCH = 0.05
"""Size in m of a patch of one colour."""

_TILES = 64  # patches after which the colours repeat: 3.2 m


class GroundColours:
    """Square patches of random reflectance on the world's plane.

    A sensor calibrated at reflectance 1 measures d / sqrt(rho), by an intensity of rho / d^2.
    """

    def __init__(self, plant: TruePlant) -> None:
        lightness = 1.0 + plant.reflectance * stream(plant.seed, "colours").uniform(-1.0, 1.0, (_TILES, _TILES))
        self._stretch = 1.0 / np.sqrt(lightness)

    def stretch(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Measured over true distance (n,) at world points (n, 3) in m."""
        tiles = np.floor(points[:, :2] / PATCH).astype(np.int64) % _TILES
        return np.asarray(self._stretch[tiles[:, 0], tiles[:, 1]])


FOAM_MODULUS = 3e5
"""Young's modulus in Pa of the foam under a sole: EVA of midsoles has 0.2 to 0.5 MPa."""


def foam_time(thickness: float, body: BodyScale) -> float:
    """Returns sqrt(m / k) in s of a `body` on foam of `thickness` in m, k = E A / thickness for one sole."""
    return math.sqrt(body.mass * thickness / (FOAM_MODULUS * body.sole * body.sole_width))


def make_ground_true(model: Any, plant: TruePlant, touching: Sequence[int], body: BodyScale) -> None:
    """Change contact friction and softness of a `model` in place into the true `plant`'s.

    Time constants add in squares, as springs in series. MuJoCo takes a pair's larger friction and mean time constant;
    differing ground pieces override both. `touching` are ids of geoms, soles and ground, `body` the size by the
    robot's file.
    """
    foam = foam_time(plant.rubber, body)
    before = model.geom_solref[touching, 0]
    model.geom_friction[touching, 0] *= plant.friction_ratio
    model.geom_solref[touching, 0] = np.hypot(np.hypot(before, plant.softness), foam)
    if not plant.patchiness:
        return
    pieces = [geom for geom in touching if model.geom_contype[geom] & GROUND_CONTACT]
    less = 1.0 - plant.patchiness * stream(plant.seed, "patches").uniform(size=(len(pieces), 2))
    hard = before[[touching.index(geom) for geom in pieces]]
    model.geom_friction[pieces, 0] *= less[:, 0]
    model.geom_solref[pieces, 0] = np.hypot(np.hypot(hard, less[:, 1] * plant.softness), foam)
    model.geom_priority[pieces] = 1
