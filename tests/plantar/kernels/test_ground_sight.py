"""The kernel of the ground that a moving sole sees: against the formulas in numpy, in both forms."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.gait import ground_sight

MODULES = (ground_sight, python_form("ground_sight"))
PLACES = np.array([[x, y] for x in np.linspace(-0.1, 0.1, 8) for y in np.linspace(-0.04, 0.04, 5)])
CORNERS = np.array([[-0.11, -0.05], [0.11, -0.05], [0.11, 0.05], [-0.11, 0.05]])
LEAST_NOISE, NOISE_SHARE, JUMP, JUMP_OF_ALL, STILL, HALVING = 0.002, 0.02, 6.0, 1.5, 60.0, 1e-4


def sight(module):
    """A map of the settings above."""
    return module.GroundSight(
        PLACES, CORNERS, (5.0, STILL, HALVING), (LEAST_NOISE, NOISE_SHARE), (JUMP, JUMP_OF_ALL), (10, 0.25), 12
    )


def risen(before, now):
    """Rise of each taxel between two poses."""
    (place, turn), (there, turned) = before, now
    up, change = turned.T @ (there - place), turn.T @ turned
    return up[2] + change[2, 0] * PLACES[:, 0] + change[2, 1] * PLACES[:, 1]


@pytest.mark.parametrize("seed", range(8))
def test_a_map_is_the_formula(seed):
    """Late readings of noisy ground with a jump, averaged while the sole moves."""
    rng = np.random.default_rng(seed)
    kernels = [sight(module) for module in MODULES]
    distance, readings, noise = np.full(len(PLACES), np.inf), np.zeros(len(PLACES)), LEAST_NOISE
    poses = []
    for k in range(30):
        place = np.array([0.002 * k, 0.0, 0.05 + 0.01 * np.sin(0.2 * k)])
        turn = Rotation.from_rotvec(0.01 * rng.normal(size=3)).as_matrix()
        pose, time = (place, turn), 0.005 * k
        if poses:
            moved = float(np.linalg.norm(place - poses[-1][1][0]))
            most = max(5.0, STILL * HALVING / (HALVING + moved))
            distance = distance + risen(poses[-1][1], pose)
        else:
            most = 5.0
        poses.append((time, pose))
        for kernel in kernels:
            kernel.move(time, *pose)
        if k % 3 == 2:
            continue  # no new reading
        reading = 0.05 + 0.001 * rng.normal(size=len(PLACES)) + (0.02 if k > 18 else 0.0)
        reading[rng.random(len(PLACES)) < 0.1] = rng.choice([np.inf, np.nan])
        read = max(0.0, time - 0.008)  # between the last pose but two and the last but one
        later = [p for p in poses if p[0] > read]
        ago = [p for p in poses if p[0] <= read][-1]
        since = risen(ago[1], pose)
        if later:
            share = (read - ago[0]) / (later[0][0] - ago[0])
            since = since + share * (risen(later[0][1], pose) - since)
        now = reading + since
        known = np.isfinite(now) & np.isfinite(distance)
        news = np.where(known, now - np.where(known, distance, 0.0), 0.0)
        if known.any():
            if abs(news[known].mean()) > JUMP_OF_ALL * noise:
                readings[:] = 0.0
            noise = max(LEAST_NOISE, noise + NOISE_SHARE * (1.4826 * np.median(np.abs(news[known])) - noise))
        readings[~known | (np.abs(news) > JUMP * noise)] = 0.0
        readings = np.minimum(readings + 1.0, most)
        distance = np.where(known, distance + news / readings, now)
        for kernel in kernels:
            kernel.mix(reading, read, *pose)
            np.testing.assert_allclose(np.asarray(kernel.distance), distance, rtol=0, atol=1e-12)
            np.testing.assert_allclose(np.asarray(kernel.readings), readings, rtol=1e-12)
            assert kernel.noise == pytest.approx(noise, rel=1e-12)


@pytest.mark.parametrize("module", MODULES, ids=["compiled", "python"])
def test_a_slope_gives_first_contact_and_middle(module):
    kernel = sight(module)
    kernel.move(0.0, np.array([0.0, 0.0, 0.1]), np.eye(3))
    assert not kernel.look(0.0)  # nothing was seen yet
    for _ in range(20):
        kernel.mix(0.03 - 0.08 * PLACES[:, 0] + 0.05 * PLACES[:, 1], 0.0, np.array([0.0, 0.0, 0.1]), np.eye(3))
    assert kernel.look(0.004)
    assert (kernel.found, kernel.sloped, kernel.on_plane, kernel.seen) == (True, True, len(PLACES), len(PLACES))
    assert (kernel.slope_x, kernel.slope_y) == pytest.approx((0.08, -0.05), abs=1e-12)
    assert kernel.middle == pytest.approx(0.026, abs=1e-12)
    assert kernel.nearest == pytest.approx(0.026 - 0.08 * 0.11 - 0.05 * 0.05, abs=1e-12)
    kernel.begin()
    assert not kernel.look(0.0)


@pytest.mark.parametrize("module", MODULES, ids=["compiled", "python"])
def test_few_taxels_give_the_mean_of_the_nearest_third(module):
    kernel = sight(module)
    kernel.move(0.0, np.zeros(3), np.eye(3))
    seen = np.full(len(PLACES), np.inf)
    seen[[0, 7, 20]] = 0.04, 0.02, 0.03
    kernel.mix(seen, 0.0, np.zeros(3), np.eye(3))
    assert kernel.look(0.0)
    assert not kernel.sloped
    assert kernel.nearest == kernel.middle == pytest.approx(0.02)
