import numpy as np
import pytest

from plantar.gait.estimate.skin_load import SkinLoad, at_its_limit, percept_to_its_limit
from plantar.layouts.tiling import hex_layout
from plantar.percepts.percept import Percept
from plantar.sensing.force import center_of_pressure
from plantar.sensing.reading import Reading

NOISE = 1.4715


@pytest.fixture(scope="module")
def sole():
    return hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])


def test_a_steady_load_without_noise_is_its_wrench(sole):
    force = np.linspace(1.0, 12.0, len(sole))
    load = SkinLoad(sole, 0.0, 0.2)
    for k in range(3):
        estimated = load.update(Reading(0.005 * k, force))
    assert estimated.vertical_force == pytest.approx(force.sum())
    # the filter has no threshold on each taxel, nor has what it is compared with
    assert estimated.position_cop_in_sole == pytest.approx(center_of_pressure(sole, force, threshold=0.0))


def test_it_follows_a_change_with_its_time_constant(sole):
    load = SkinLoad(sole, 0.0, 0.2)
    load.update(Reading(0.0, np.zeros(len(sole))))
    for k in range(1, 6):
        estimated = load.update(Reading(0.005 * k, np.full(len(sole), 10.0)))
        assert estimated.vertical_force == pytest.approx(10.0 * len(sole) * (1.0 - 0.8**k))


def test_a_light_foot_is_felt_where_a_threshold_would_drop_it(sole):
    """1 N on each taxel is below the threshold of 0.15 kg."""
    rng = np.random.default_rng(0)
    load = SkinLoad(sole, NOISE, 0.2)
    estimated, clipped = [], []
    for k in range(2000):
        force = np.clip(1.0 + rng.normal(0.0, NOISE, len(sole)), 0.0, None)
        estimated.append(load.update(Reading(0.005 * k, force)).vertical_force)
        clipped.append(force.sum())
    assert np.mean(estimated[50:]) == pytest.approx(len(sole), rel=0.1)
    assert np.mean(clipped[50:]) > 1.2 * len(sole)


def test_dead_taxels_carry_nothing(sole):
    force = np.full(len(sole), 10.0)
    force[:3] = np.nan
    estimated = SkinLoad(sole, NOISE, 0.2).update(Reading(0.0, force))
    assert estimated.vertical_force == pytest.approx(10.0 * (len(sole) - 3))


def test_a_foot_that_stands_on_one_taxel_carries_what_that_can_measure(sole):
    force = np.zeros(len(sole))
    force[7] = sole.force_limit
    held = at_its_limit(Reading(0.0, force), sole)
    assert Percept(sole, Reading(0.0, force)).vertical_force == 0.0
    assert Percept(sole, held).vertical_force == pytest.approx(sole.force_limit)
    sound = Reading(0.0, np.minimum(force, 500.0))
    assert at_its_limit(sound, sole) is sound


@pytest.mark.parametrize("largest", [0.0, 2.0, 50.0, 1e4])
def test_a_percept_with_its_loads_summed_is_that_of_the_limited_reading(sole, largest):
    force = largest * np.random.default_rng(0).random(len(sole))
    force[3] = np.nan
    reading = Reading(0.0, force)
    percept, plain = percept_to_its_limit(reading, sole), Percept(sole, at_its_limit(reading, sole))
    assert (percept.reading is reading) == (largest < sole.force_limit)
    for name in Percept.members():
        if name in (
            "vertical_force",
            "contact_area",
            "position_cop_in_sole",
            "wrench_in_sole",
            "active",
            "support_area",
        ):
            found, wanted = getattr(percept, name), getattr(plain, name)
            assert np.array_equal(found, wanted) if wanted is not None else found is None
    assert set(vars(plain)) >= set(vars(percept))
    assert not percept.wrench_in_sole.flags.writeable
    assert percept.position_cop_in_sole is None or not percept.position_cop_in_sole.flags.writeable
