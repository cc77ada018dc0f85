"""The fit's derivatives, and the moment arms of cells."""

import numpy as np
import pytest
import shapely
from faulty_soles import Faults, rolled

from plantar import hex_layout
from plantar.calibration.fit import ResponseFit, _moment_arms, _second_moment, _Unknowns
from plantar.calibration.take import Take
from plantar.calibration.windows import windows_of

SOLE = hex_layout([[-0.07, -0.045], [0.09, -0.045], [0.09, 0.045], [-0.07, 0.045]], cell_area=691e-6, clip=False)


def test_derivatives_are_those_of_differences():
    rng = np.random.default_rng(0)
    faults = Faults.drawn(rng, SOLE)
    time, force = rolled(rng, SOLE, 4.0)
    counts = {"left": faults.counts(force, rng) - 4095.0 * faults.offset}
    cop = {"left": force @ SOLE.positions[:, :2] / force.sum(axis=1, keepdims=True)}
    zero, top = {"left": np.zeros(len(SOLE))}, {"left": counts["left"].max(axis=0)}
    fit = ResponseFit(
        {"left": SOLE}, [windows_of(Take("press", time, counts, force.sum(axis=1), cop), zero, top)], 30.0
    )
    known = _Unknowns(rng.uniform(0.03, 0.06, len(SOLE)))
    known.deviation = rng.normal(0.0, 0.05, len(SOLE))
    known.shared = np.array([0.1, 0.02, 0.08, 0.02, 0.04])
    n = len(SOLE)
    for row in fit._rows(fit._takes[0]):
        jacobian = fit._predicted(row, known)[1]
        for at in (0, n - 1, n, 2 * n - 1, *range(2 * n, 2 * n + 5)):
            ends = []
            for step in (-1e-5, 1e-5):
                moved = _Unknowns(known.gain * np.exp(np.where(np.arange(n) == at, step, 0.0)))
                moved.deviation = known.deviation + np.where(np.arange(n) == at - n, step, 0.0)
                moved.shared = known.shared + np.where(np.arange(5) == at - 2 * n, step, 0.0)
                ends.append(fit._predicted(row, moved)[0])
            difference = (ends[1] - ends[0]) / 2e-5
            assert jacobian[:, at] == pytest.approx(difference, rel=1e-3, abs=1e-6 * np.abs(row.target).max())


def test_a_load_that_rises_evenly_has_its_moment_about_the_true_place():
    """The moment of a pressure that rises evenly along x, against the integral over the cells."""
    slope = 8e5  # Pa/m
    pressure = 1e5 + slope * SOLE.positions[:, 0]
    force = pressure * SOLE.areas
    exact = 0.0
    for i in range(len(SOLE)):
        ring = shapely.Polygon(SOLE.cell_polygon(i))
        fine = _grid(ring, 200).tolist()
        weight = ring.area / len(fine)
        exact += sum(weight * (1e5 + slope * x) * x for x, _ in fine)
    assert _moment_arms(SOLE)[0] @ force == pytest.approx(exact, rel=2e-3)
    assert abs(SOLE.positions[:, 0] @ force / exact - 1.0) > 0.01


def _grid(ring, count):
    low_x, low_y, high_x, high_y = ring.bounds
    x, y = np.meshgrid(np.linspace(low_x, high_x, count), np.linspace(low_y, high_y, count))
    inside = shapely.contains_xy(ring, x.ravel(), y.ravel())
    return np.column_stack([x.ravel(), y.ravel()])[inside]


def test_second_moments_of_a_square_and_a_hexagon():
    assert _second_moment(np.array([[0, 0], [2, 0], [2, 2], [0, 2]], float)) == pytest.approx(2**4 / 12)
    angle = np.arange(6) * np.pi / 3
    assert _second_moment(np.column_stack([np.cos(angle), np.sin(angle)])) == pytest.approx(5 * np.sqrt(3) / 16)
