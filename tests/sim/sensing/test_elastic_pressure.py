"""The second taxel model: conservation, its independence of the first, and what it costs."""

import math
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import SceneError, hex_layout
from plantar.geometry.polygon import closest_point
from plantar.sim.run.scene import load_scene
from plantar.sim.sensing.elastic_pressure import ElasticPressure
from plantar.sim.sensing.sensors import SensorSuite
from plantar.sim.sensing.settings import Sensing
from plantar.sim.sensing.sole_pressure import SolePressure

from ...examples import examples

HALF = np.array([0.125, 0.0775])
OUTLINE = HALF * [[-1, -1], [1, -1], [1, 1], [-1, 1]]
LAYOUT = hex_layout(OUTLINE)
WHOLE = [(float(x), float(y)) for x, y in OUTLINE]
BEAM = [(-0.02, -0.0775), (0.04, -0.0775), (0.04, 0.0775), (-0.02, 0.0775)]
LAYER = ElasticPressure(LAYOUT, thickness=0.012)
HALF_SPACE = ElasticPressure(LAYOUT, thickness=math.inf)


@examples(20)
@given(x=st.floats(-0.018, 0.038), y=st.floats(-0.07, 0.07), force=st.floats(1.0, 2000.0))
def test_force_and_centre_of_pressure_are_the_true_ones(x, y, force):
    for pressure in (LAYER, HALF_SPACE):
        shape = pressure._patches.of(BEAM)
        load = np.array([1.0, *closest_point(shape.reach, (x, y))])
        points, forces = shape.contact.points, force * shape.contact.press(load).forces
        assert (forces >= 0.0).all()
        assert forces.sum() == pytest.approx(force)
        # The outermost squares' middles are half a square inside the edge.
        assert forces @ points / force == pytest.approx([x, y], abs=0.004)
        assert pressure.spread(BEAM, force, (x, y)).sum() == pytest.approx(force)


@examples(5)
@given(st.lists(st.tuples(st.floats(-0.1, 0.1), st.floats(-0.06, 0.06)), min_size=2, max_size=3))
def test_readings_do_not_depend_on_those_before(loads):
    used = ElasticPressure(LAYOUT, thickness=0.012)
    for load in loads:
        found = used.spread(WHOLE, 800.0, load)
    assert found == pytest.approx(ElasticPressure(LAYOUT, thickness=0.012).spread(WHOLE, 800.0, loads[-1]), abs=1.0)


def test_taxels_at_an_edge_carry_more_on_a_thick_layer_and_the_same_on_springs():
    middle = (0.0, 0.0)
    rim = np.abs(LAYOUT.positions[:, 0]) > 0.09
    core = (np.abs(LAYOUT.positions[:, 0]) < 0.04) & (np.abs(LAYOUT.positions[:, 1]) < 0.03)

    def ratio(pressure: ElasticPressure | SolePressure) -> float:
        found = pressure.spread(WHOLE, 800.0, middle) / LAYOUT.areas
        return float(found[rim].mean() / found[core].mean())

    assert ratio(SolePressure(LAYOUT)) == pytest.approx(1.0, abs=1e-9)
    assert ratio(ElasticPressure(LAYOUT, thickness=0.03)) > 1.02
    assert ratio(HALF_SPACE) > 1.5


def test_taxels_off_the_ground_stay_silent():
    force = LAYER.spread(BEAM, 800.0, (0.01, 0.0))
    beyond = (LAYOUT.positions[:, 0] > 0.04 + 0.02) | (LAYOUT.positions[:, 0] < -0.02 - 0.02)
    assert force[beyond].max() == 0.0
    over = (LAYOUT.positions[:, 0] > -0.015) & (LAYOUT.positions[:, 0] < 0.035)
    assert (force[over] > 0.0).all()


def test_nothing_on_it_presses_nothing():
    for force in (0.0, -5.0, math.inf, math.nan):
        assert not LAYER.spread(WHOLE, force, (0.0, 0.0)).any()
    assert not LAYER.spread([], 10.0, (0.0, 0.0)).any()


def test_a_load_beside_the_taxels_goes_to_the_nearest():
    assert LAYER.spread([(0.3, 0.0)], 10.0, (0.3, 0.0)).sum() == pytest.approx(10.0)
    assert LAYER.spread(WHOLE, 100.0, (0.3, 0.0)).sum() == pytest.approx(100.0)


def test_a_reading_of_a_swaying_load_costs_little_beside_a_new_layer():
    """A centre of pressure that sways slowly over the sole and its edges, as one of a walk does: 2 to 3 % here."""
    sway = [(0.1 * math.sin(0.02 * k), 0.06 * math.sin(0.013 * k)) for k in range(500)]
    begin = time.thread_time()
    ElasticPressure(LAYOUT, thickness=0.012).spread(WHOLE, 800.0, sway[0])
    new = time.thread_time() - begin
    begin = time.thread_time()
    for load in sway:
        LAYER.spread(WHOLE, 800.0, load)
    assert (time.thread_time() - begin) / len(sway) < 0.2 * new


def test_a_scene_chooses_the_model():
    scene = load_scene("flat", ("sensing.taxels=elastic", "sensing.layer=0.02"), "h1")
    assert scene.sensing.taxels == "elastic"
    with pytest.raises(SceneError, match="winkler, elastic"):
        load_scene("flat", ("sensing.taxels=flubber",), "h1")


def test_the_suite_makes_skins_of_the_chosen_model(world):
    for skin in SensorSuite(world, Sensing(taxels="elastic", layer=0.02), 0).skins.values():
        assert isinstance(skin.skin.pressure, ElasticPressure)
        assert skin.skin.pressure.thickness == 0.02
    assert isinstance(SensorSuite(world, Sensing(), 0).skins["left"].skin.pressure, SolePressure)
