"""The kernel of the swing foot's path: both forms give the same bits, and a path that keeps its ends."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import kernels
from plantar.kernels.gait import swing_fit

from ...examples import examples

INTERPRETED = kernels.python_form("swing_fit")


def path(form, seed: int, now: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The path of a drawn problem, and its way."""
    rng = np.random.default_rng(seed)
    order = int(rng.integers(5, 10))
    m = order - 1
    same, high = rng.normal(size=(2, m, m))
    same, high = (np.column_stack([a @ a.T + np.eye(m), rng.normal(size=(m, 2))]) for a in (same, high))
    conditions = rng.normal(size=(3, 4))
    conditions[:, 0] **= 2
    way, out, work = rng.normal(size=3), np.full((3, 3), np.nan), np.full((6 + 2 * m, order + 1), np.nan)
    before, at = rng.uniform(size=2)
    same = np.ascontiguousarray(same[:, : m + 1])
    form.fit(order, at if now is None else now, before, conditions, same, high, 0.3, way, work, out)
    return out, way


@given(st.integers(0, 2**32 - 1))
@examples(30)
def test_both_forms_agree_to_the_last_bit(seed):
    assert np.array_equal(path(swing_fit, seed)[0], path(INTERPRETED, seed)[0])


@pytest.mark.parametrize("seed", range(5))
def test_the_path_begins_at_nothing_and_ends_at_its_way(seed):
    begin, _ = path(swing_fit, seed, 0.0)
    end, way = path(swing_fit, seed, 1.0)
    assert begin[0] == pytest.approx(np.zeros(3), abs=1e-12)
    assert end[0] == pytest.approx(way, abs=1e-9)
    ahead, here, behind = (path(swing_fit, seed, 0.4 + d)[0] for d in (1e-5, 0.0, -1e-5))
    assert (ahead[:2] - behind[:2]) / 2e-5 == pytest.approx(here[1:], rel=1e-5, abs=1e-5)
