"""The cone of a rectangle against the span of its 16 corner rays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from plantar.errors import InputError
from plantar.mechanics.wrench_cone import Rectangle, wrench_cone

from ...examples import examples

ASYMMETRIC = Rectangle(-0.08, 0.13, -0.03, 0.09)


def corner_rays(r: Rectangle, mu: float) -> np.ndarray:
    """Wrench (16, 6) of each edge of the friction pyramid at each corner, normal force 1."""
    rays = []
    for x in (r.x_min, r.x_max):
        for y in (r.y_min, r.y_max):
            for sx in (-mu, mu):
                for sy in (-mu, mu):
                    force = np.array([sx, sy, 1.0])
                    rays.append([*force, *np.cross([x, y, 0.0], force)])
    return np.array(rays)


def hull_facets(r: Rectangle, mu: float) -> np.ndarray:
    """Facets (k, 6) of the rays' span, rows of length 1, each once."""
    rays = corner_rays(r, mu)
    scale = np.array([1.0, 1.0, 1.0, 10.0, 10.0, 10.0])
    hull = ConvexHull(np.vstack([np.zeros(6), rays * scale]))
    through_zero = hull.equations[np.abs(hull.equations[:, -1]) < 1e-9, :-1] * scale
    rows = through_zero / np.linalg.norm(through_zero, axis=1)[:, None]
    return np.unique(rows.round(7), axis=0)


@pytest.mark.parametrize("mu", [0.2, 0.6, 1.1])
@pytest.mark.parametrize("rectangle", [ASYMMETRIC, Rectangle(0.02, 0.2, 0.01, 0.05), Rectangle(-0.1, 0.1, -0.1, 0.1)])
def test_the_facets_are_those_of_the_corner_rays_hull(rectangle, mu):
    rows = wrench_cone(rectangle, mu)
    ours = rows / np.linalg.norm(rows, axis=1)[:, None]
    hull = hull_facets(rectangle, mu)
    assert len(hull) == len(ours) == 16
    for row in ours:
        assert np.abs(hull - row).max(axis=1).min() < 1e-6


def test_the_printed_yaw_limits_are_not_the_hull():
    """T 4.38 splits |Y fx - mu tx| with Y = Ymax: on an asymmetric rectangle a corner ray then leaves the cone."""
    x0, x1, y0, y1 = ASYMMETRIC
    mu = 0.6
    printed = np.array(
        [
            [-y1, -x1, -mu * (x1 + y1), mu, mu, -1.0],
            [-y1, x0, -mu * (x0 + y1), mu, -mu, -1.0],
            [y0, -x1, -mu * (x1 + y0), -mu, mu, -1.0],
            [y0, x0, -mu * (x0 + y0), -mu, -mu, -1.0],
        ]
    )
    rays = corner_rays(ASYMMETRIC, mu)
    assert (rays @ printed.T).max() > 1e-3
    assert (rays @ wrench_cone(ASYMMETRIC, mu).T).max() < 1e-12


@examples(60)
@given(
    seed=st.integers(0, 10**6),
    low=st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)),
    size=st.tuples(st.floats(0.0, 0.3), st.floats(0.0, 0.3)),
    mu=st.floats(0.05, 2.0),
)
def test_sums_of_corner_forces_are_inside(seed, low, size, mu):
    r = Rectangle(low[0], low[0] + size[0], low[1], low[1] + size[1])
    rng = np.random.default_rng(seed)
    wrench = rng.exponential(50.0, (20, 16)) @ corner_rays(r, mu)
    assert (wrench @ wrench_cone(r, mu).T).max() < 1e-9 * np.abs(wrench).max()


@pytest.mark.parametrize(
    ("rectangle", "mu"),
    [
        (Rectangle(0.1, -0.1, 0.0, 0.1), 0.6),
        (Rectangle(0.0, 0.1, 0.1, 0.0), 0.6),
        (Rectangle(0.0, float("nan"), 0.0, 0.1), 0.6),
        (ASYMMETRIC, 0.0),
        (ASYMMETRIC, float("inf")),
    ],
)
def test_what_is_no_contact_is_refused(rectangle, mu):
    with pytest.raises(InputError, match="allowed"):
        wrench_cone(rectangle, mu)
