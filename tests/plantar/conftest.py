"""What several tests of wrenches share: curved soles, and a slow and plain reference."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar import SoleLayout


def _tilted_sole(seed: int, n: int = 12) -> SoleLayout:
    rng = np.random.default_rng(seed)
    positions = rng.uniform(-0.1, 0.1, (n, 3))
    vertices = np.concatenate([positions + np.array(d) for d in ([0.001, 0, 0], [0, 0.001, 0], [-0.001, -0.001, 0])])
    return SoleLayout(
        name="curved",
        side="left",
        positions=positions,
        rotations=Rotation.from_rotvec(rng.uniform(-0.6, 0.6, (n, 3))).as_matrix(),
        vertices=vertices,
        corners=tuple((i, n + i, 2 * n + i) for i in range(n)),
        neighbours=((),) * n,
        areas=rng.uniform(1e-6, 3e-6, n),
        outline=np.array([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]]),
        ids=np.arange(n),
        cell_shape="polygon",
        modalities=("force", "proximity", "temperature"),
    )


def _pushed(layout: SoleLayout, normal: np.ndarray) -> np.ndarray:
    total = np.zeros(6)
    for r, rotation, f in zip(layout.positions, layout.rotations, normal, strict=True):
        force = rotation @ np.array([0.0, 0.0, f])
        total += np.concatenate([force, np.cross(r, force)])
    return total


@pytest.fixture(scope="session")
def tilted_sole():
    """Makes soles from a seed: taxels in random places, tilted by up to about 60 degrees, with areas of their own."""
    return _tilted_sole


@pytest.fixture(scope="session")
def pushed():
    """Wrench of forces along each taxel's z axis, one taxel and one cross product at a time (T 3.16-3.17)."""
    return _pushed
