import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError, Percept, Reading, hex_layout, laid_over, walking_tick
from plantar.geometry.polygon import closest_point, inner_offset

from ...examples import examples

OUTLINE = [[-0.12, -0.05], [0.12, -0.04], [0.12, 0.04], [-0.12, 0.05]]
SOLES = {"flat": hex_layout(OUTLINE), "curved": laid_over(hex_layout(OUTLINE), lambda x, y: x * x - y * y)}


@examples(100)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from(sorted(SOLES)),
    st.sampled_from([0.0, 1e-9, 0.01, 0.03, 1.0]),
    st.sampled_from([0.0, 0.02, 0.1, 0.9]),
)
def test_a_tick_is_what_percept_and_polygons_give(seed, sole, offset, share):
    rng = np.random.default_rng(seed)
    layout = SOLES[sole]
    force = np.where(rng.random(len(layout)) < share, rng.uniform(0.0, 60.0, len(layout)), 0.0)
    force[rng.random(len(layout)) < 0.05] = rng.choice([np.nan, np.inf, -5.0, 785.0, 1e300])
    aim = rng.uniform(-0.2, 0.2, 2)
    tick = walking_tick(layout, force, aim, offset)
    percept = Percept(layout, Reading(0.0, force))
    assert (tick.active == percept.active).all()
    assert tick.wrench.tolist() == percept.wrench_in_sole.tolist()
    assert (tick.contact_area, tick.support_area) == (percept.contact_area, percept.support_area)
    assert tick.support_polygon.tolist() == percept.support_polygon_in_sole.tolist()
    safe = inner_offset(percept.support_polygon_in_sole, offset)
    assert tick.safe_polygon.tolist() == safe.tolist()
    for ours, wanted in (
        (tick.position_cop, percept.position_cop_in_sole),
        (tick.centroid, percept.centroid_in_sole),
        (tick.clamped, closest_point(safe, aim)),
    ):
        assert (ours is None) == (wanted is None)
        assert ours is None or ours.tolist() == wanted.tolist()


def test_a_tick_takes_a_threshold_and_lists():
    layout = SOLES["flat"]
    assert not walking_tick(layout, [2.0] * len(layout), (0.0, 0.0), threshold=3.0).active.any()
    assert walking_tick(layout, [2] * len(layout), (0.0, 0.0), threshold=1.0).active.all()


def test_a_bad_offset_is_refused():
    layout = SOLES["flat"]
    for offset in (-0.01, float("nan")):
        with pytest.raises(InputError, match="offset of the safe polygon"):
            walking_tick(layout, np.zeros(len(layout)), (0.0, 0.0), offset)


def test_an_aim_that_is_no_point_gives_nan():
    layout = SOLES["flat"]
    assert np.isnan(walking_tick(layout, np.full(len(layout), 9.0), (np.nan, 0.0), 0.01).clamped).all()
