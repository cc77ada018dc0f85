"""What the seed draws: from the stated ranges, in proportion to the level, alone as with all others."""

import math
from dataclasses import fields

import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.common.sides import SIDES
from plantar.robots import load_robot
from plantar.sim.plant.draw import RANGES, TruePlant, drawn_plant
from plantar.sim.plant.settings import EVERYTHING, RANDOM, STATED, Plant

LAYOUTS = load_robot("h1").layouts
SEEDS = range(300)


def drawn(plant: Plant, seed: int, body: BodyScale = REFERENCE_BODY) -> TruePlant:
    found = drawn_plant(plant, seed, body, 12, LAYOUTS)
    assert found is not None
    return found


def everything(level: float) -> Plant:
    return Plant(draw=EVERYTHING, level=level)


def same(one: TruePlant, other: TruePlant, name: str) -> bool:
    a, b = getattr(one, name), getattr(other, name)
    if name in ("taxel_gains", "taxel_drifts"):
        return all(np.array_equal(a[side], b[side]) for side in SIDES)
    return np.array_equal(a, b)


def test_every_item_has_a_range():
    assert tuple(RANGES) == Plant.items()


def test_level_0_and_nothing_stated_are_the_nominal_plant():
    assert drawn_plant(everything(0.0), 5, REFERENCE_BODY, 12, LAYOUTS) is None
    assert drawn_plant(Plant(), 5, REFERENCE_BODY, 12, LAYOUTS) is None
    assert drawn_plant(Plant(level=3.0), 5, REFERENCE_BODY, 12, LAYOUTS) is None


def test_the_seed_decides():
    names = [f.name for f in fields(TruePlant) if f.name != "seed"]
    first, again, other = drawn(everything(2.0), 3), drawn(everything(2.0), 3), drawn(everything(2.0), 4)
    assert all(same(first, again, name) for name in names)
    whole = {
        "crosstalk",
        "sensor_delay",
        "actuation_delay",
        "torque_ripple",
        "hysteresis",
        "dropout",
        "patchiness",
        "reflectance",
        *STATED,
    }
    assert {name for name in names if same(first, other, name)} == whole


def test_at_level_2_draws_fill_the_stated_ranges():
    plants = [drawn(everything(2.0), seed) for seed in SEEDS]
    gyro = np.abs([p.gyro_bias for p in plants])
    assert 0.0049 < gyro.max() <= 0.005
    com = np.array([p.com_offset for p in plants])
    assert 0.0195 < np.linalg.norm(com, axis=1).max() <= 0.02
    assert np.abs(com.mean(axis=0)).max() < 0.002  # no way is preferred
    for name, low, high in (
        ("mass_ratio", 0.9, 1.1),
        ("stiffness_ratio", 0.5, 1.0),
        ("friction_ratio", 0.4, 1.0),
        ("softness", 0.0, 0.03),
        ("joint_friction", 0.0, 0.005 * REFERENCE_BODY.weight * REFERENCE_BODY.leg),
        ("rubber", 0.0, 0.03 * REFERENCE_BODY.sole),
        ("backlash", 0.0, math.radians(0.1)),
    ):
        values = np.array([getattr(p, name) for p in plants])
        edge = 0.03 * (high - low)
        assert low <= values.min() < low + edge, name
        assert high - edge < values.max() <= high, name
    zeros = np.degrees(np.abs([p.encoder_offsets for p in plants]))
    assert 0.299 < zeros.max() <= 0.3
    gains = np.concatenate([p.taxel_gains[side] for p in plants for side in SIDES])
    assert gains.std() == pytest.approx(0.15, rel=0.03)
    assert gains.min() >= 0.1
    assert {(p.crosstalk, p.sensor_delay, p.actuation_delay) for p in plants} == {(0.1, 0.01, 0.01)}


def test_the_level_scales_what_is_drawn():
    one, three = drawn(everything(1.0), 7), drawn(everything(3.0), 7)
    for name in ("gyro_bias", "com_offset", "encoder_offsets", "softness", "crosstalk", "sensor_delay"):
        assert getattr(three, name) == pytest.approx(3.0 * getattr(one, name)), name
    for name in ("mass_ratio", "stiffness_ratio", "friction_ratio"):
        assert getattr(three, name) - 1.0 == pytest.approx(3.0 * (getattr(one, name) - 1.0)), name


@pytest.mark.parametrize("name", Plant.items())
def test_an_item_that_is_drawn_alone_is_what_it_is_with_all_others(name):
    alone, together = drawn(Plant(**{name: RANDOM}), 11), drawn(everything(2.0), 11)
    lists = {"encoder_offset": "encoder_offsets", "taxel_gain": "taxel_gains", "taxel_drift": "taxel_drifts"}
    assert same(alone, together, lists.get(name, name))
    assert len(alone.summary()) == 1


def test_the_centre_of_mass_goes_with_the_leg():
    small = BodyScale(mass=3.0, leg=0.2, sole=0.1, sole_width=0.05)
    h1 = drawn(everything(2.0), 1)
    assert drawn(everything(2.0), 1, small).com_offset == pytest.approx(h1.com_offset * 0.2 / 0.6)
    assert drawn(everything(2.0), 1, small).gyro_bias == pytest.approx(h1.gyro_bias)


def test_what_is_stated_is_what_is_so():
    plant = drawn(Plant(gyro_bias=(0.001, -0.002, 0.003), com_offset=("1/30 leg", 0.0, 0.0), mass_ratio=1.1), 0)
    assert plant.gyro_bias.tolist() == [0.001, -0.002, 0.003]
    assert plant.com_offset == pytest.approx([0.02, 0.0, 0.0])
    assert plant.summary() == {
        "gyro_bias_rad_s": [0.001, -0.002, 0.003],
        "com_offset_m": [0.02, 0.0, 0.0],
        "mass_ratio": 1.1,
    }
