"""What the soles feel in the corner of a video: colours by force, a cross at the CoP, forces in N."""

import numpy as np
import pytest

from plantar.sensing.reading import Reading
from plantar.sim.figures.drawn_run import scale_colours
from plantar.sim.figures.sole_inset import SoleInset

WEIGHT = 800.0


@pytest.fixture
def inset(h1):
    return SoleInset(h1.layouts, WEIGHT, 130)


def drawn(inset: SoleInset, left: np.ndarray, time: float = 0.0) -> np.ndarray:
    picture = np.zeros((540, 960, 3), dtype=np.uint8)
    inset.draw(picture, {"left": Reading(time, left), "right": Reading(time, np.zeros(42))}, time)
    return picture


def test_the_rest_of_the_picture_stays_as_it_is(inset):
    picture = drawn(inset, np.full(42, 10.0))
    assert (picture[130:] == 0).all()
    assert (picture[:130, :300] > 0).any()


def test_a_taxel_has_the_colour_of_its_force_and_toes_are_up(inset, h1):
    x = h1.layouts["left"].positions[:, 0]
    toe = int(np.argmax(x))
    force = np.zeros(42)
    force[toe] = 0.1 * WEIGHT
    picture = drawn(inset, force)[:130, :100].astype(int)
    none, full = scale_colours(255)[[0, -1]]
    bright = np.argwhere(np.abs(picture - full).sum(axis=2) < 30)
    dark = np.argwhere(np.abs(picture - none).sum(axis=2) < 30)
    assert 10 < len(bright) < len(dark) / 10  # less its edges and the cross
    assert bright[:, 0].max() < np.median(dark[:, 0])


def test_the_cross_stands_at_the_center_of_pressure(inset, h1):
    layout = h1.layouts["left"]
    force = np.where(layout.positions[:, 0] > np.median(layout.positions[:, 0]), 20.0, 1.0)
    picture = drawn(inset, force)[:130, :100].astype(int)
    cross = np.argwhere(np.abs(picture - [217, 26, 77]).sum(axis=2) < 60)
    cop = force @ layout.positions[:, :2] / force.sum()
    ((column, row),) = inset._pixels("left", cop[None])
    assert cross.mean(axis=0) == pytest.approx([row, column], abs=1.5)


def test_forces_leave_the_chart_after_some_seconds(inset):
    for i in range(200):
        drawn(inset, np.full(42, 10.0), 0.04 * i)
    times = [time for time, _ in inset._past]
    assert times[0] == pytest.approx(times[-1] - 4.0, abs=0.041)
    assert inset._past[-1][1] == pytest.approx((420.0, 0.0))


def test_the_words_over_the_forces_stay_free_of_their_lines(inset):
    """A foot that carries all, with a tenth of noise, and one that carries nothing: the words look the same."""
    noise = 1.0 + 0.1 * np.random.default_rng(0).uniform(-1.0, 1.0, 100)
    for i, share in enumerate(noise):
        loaded = drawn(inset, np.full(42, share * WEIGHT / 42), 0.04 * i)
    free = drawn(SoleInset(inset._layouts, WEIGHT, 130), np.zeros(42))
    words = np.s_[: 130 // 7, inset._chart : inset._width]
    assert (free[words].min(axis=-1) < 120).sum() > 50
    assert np.array_equal(loaded[words], free[words])
