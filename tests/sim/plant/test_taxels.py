"""Taxels of the true plant: what crosstalk, hysteresis, gain, drift and connectors do to known forces."""

import math

import mujoco
import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.sides import SIDES, Side
from plantar.robots import load_robot
from plantar.sensing.taxel_faults import WARMING
from plantar.sim.plant.draw import TruePlant, drawn_plant
from plantar.sim.plant.settings import Plant
from plantar.sim.plant.taxels import CONNECTORS, SILENCE, TaxelErrors
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.sensing.sensors import SensorSuite
from plantar.sim.sensing.settings import Sensing

QUIET = Sensing(force_noise=0.0, encoder_noise=0.0, gyro_noise=0.0, accelerometer_noise=0.0)
LAYOUTS = load_robot("h1").layouts
LEFT = LAYOUTS["left"]
COUNT = len(LEFT)


def plant_of(**settings: object) -> TruePlant:
    found = drawn_plant(Plant(**settings), 2, REFERENCE_BODY, 12, LAYOUTS)
    assert found is not None
    return found


def errors_of(side: Side = "left", **settings: object) -> TaxelErrors:
    return TaxelErrors(LAYOUTS[side], plant_of(**settings), side)


def test_taxels_read_their_gain_times_what_is_on_them():
    plant = plant_of(taxel_gain=0.2)
    force = np.linspace(1.0, 5.0, COUNT)
    felt = TaxelErrors(LEFT, plant, "left").read(force, 0.0)
    assert felt / force == pytest.approx(plant.taxel_gains["left"])
    assert not np.array_equal(plant.taxel_gains["left"], plant.taxel_gains["right"])


def loop_area(hysteresis: float, peak: float) -> float:
    """Area in N^2 that a reading encloses over its force while that goes up to a peak and down again."""
    errors = errors_of(hysteresis=hysteresis, crosstalk=1e-12)
    up = np.linspace(0.0, peak, 2001)
    force = np.concatenate([up, up[::-1]])
    read = np.array([errors.read(np.full(COUNT, f), 0.0)[0] for f in force])
    assert read[-1] == pytest.approx(0.0, abs=1e-9)
    return -float(np.trapezoid(read, force))


def test_a_load_that_comes_and_goes_draws_a_loop_of_the_known_area():
    assert loop_area(0.0, 40.0) == pytest.approx(0.0, abs=1e-6)
    for h in (0.1, 0.3):
        turn = (1.0 - h) / (1.0 + h)  # share of the peak at which the reading begins to go down
        area = (1.0 - h) * (1.0 - turn) + 0.5 * (1.0 + h) * turn**2 - 0.5 * (1.0 - h)
        assert loop_area(h, 40.0) == pytest.approx(40.0**2 * area, rel=1e-3)


def test_hysteresis_does_not_depend_on_the_rate():
    force = 30.0 * np.abs(np.sin(np.linspace(0.0, 9.0, 4001)))
    slow, fast = errors_of(hysteresis=0.2), errors_of(hysteresis=0.2)
    read = [slow.read(np.full(COUNT, f), 0.0)[0] for f in force]
    every_fourth = [fast.read(np.full(COUNT, f), 0.0)[0] for f in force[::4]]
    assert every_fourth == pytest.approx(read[::4], abs=0.02)


def test_zeros_wander_off_as_the_sole_becomes_warm():
    plant = plant_of(taxel_drift=1.5)
    errors = TaxelErrors(LEFT, plant, "left")
    nothing = np.zeros(COUNT)
    assert not errors.read(nothing, 0.0).any()
    assert errors.read(nothing, WARMING) == pytest.approx((1.0 - math.exp(-1.0)) * plant.taxel_drifts["left"])
    assert errors.read(nothing, 100.0 * WARMING) == pytest.approx(plant.taxel_drifts["left"])
    assert np.std(np.concatenate([plant.taxel_drifts[side] for side in SIDES])) == pytest.approx(1.5, rel=0.25)


def test_a_connector_silences_its_taxels_for_its_share_of_the_time():
    errors, period = errors_of(dropout=0.2), 0.004
    silent = np.empty((60000, COUNT), dtype=bool)
    for k in range(len(silent)):
        force, distance = np.ones(COUNT), np.ones(COUNT)
        errors.silence(period * k, force, distance, None)
        silent[k] = np.isnan(force)
        assert np.array_equal(np.isnan(distance), silent[k])
    banks = np.unique(silent, axis=1).shape[1]
    assert banks == CONNECTORS
    assert silent.mean() == pytest.approx(0.2, rel=0.1)
    lost = np.count_nonzero(np.diff(silent[:, 0].astype(int)) == 1)
    assert silent[:, 0].sum() * period / lost == pytest.approx(SILENCE, rel=0.15)
    heelmost = np.flatnonzero((silent == silent[:, [np.argmin(LEFT.positions[:, 0])]]).all(axis=0))
    others = np.setdiff1d(np.arange(COUNT), heelmost)
    assert len(heelmost) == pytest.approx(COUNT / CONNECTORS, abs=1.0)
    assert LEFT.positions[heelmost, 0].max() <= LEFT.positions[others, 0].min() + 1e-9


def test_no_dropout_draws_nothing_and_silences_nothing():
    errors, force = errors_of(hysteresis=0.1), np.ones(COUNT)
    for k in range(1000):
        errors.silence(0.004 * k, force)
    assert not np.isnan(force).any()


def test_a_sole_s_reading_has_the_errors_of_its_taxels():
    world = Simulation(load_scene("flat", ["steps=0"]), 0).world
    mujoco.mj_forward(world.model, world.data)
    plant = plant_of(taxel_gain=0.2, crosstalk=0.1)
    suites = [SensorSuite(world, QUIET, 0, plant=true) for true in (None, plant)]
    for suite in suites:
        suite.read_skins()
    for side in SIDES:
        clean, felt = (suite.readings[side].force for suite in suites)
        assert felt == pytest.approx(TaxelErrors(LAYOUTS[side], plant, side).read(clean, 0.0))
