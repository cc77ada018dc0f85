"""Readings of soles without taxels, against loads that are known."""

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.command import Sensors
from plantar.geometry.polygon import closest_point, convex_hull
from plantar.mechanics.lip import GRAVITY
from plantar.robots.controller import load_controller
from plantar.robots.sole_readings import LoadSpread

REST = np.zeros(3), np.array([0.0, 0.0, GRAVITY])


@pytest.fixture(scope="module", params=["h1", "hrp2kai"])
def walker(request):
    return load_controller(request.param, soles="torques")


def test_a_load_is_spread_exactly_and_never_pulls(walker):
    layout = walker.robot.layouts["left"]
    spread = LoadSpread(layout)
    rng = np.random.default_rng(5)
    low = layout.outline.min(axis=0)
    high = layout.outline.max(axis=0)
    for load in (3.0, 40.0, 400.0):
        for point in rng.uniform(low, high, (20, 2)):
            forces = spread.forces(load, point)
            assert forces.sum() == pytest.approx(load)
            assert forces.min() >= 0.0
            assert load < 4.0 or (forces > layout.force_threshold).sum() >= 1
    inside = 0.3 * (low + high)
    forces = spread.forces(400.0, inside)
    assert forces @ spread.places / 400.0 == pytest.approx(inside, abs=1e-6)


@pytest.mark.parametrize("load", [15.0, 25.0, 100.0, 400.0, 900.0])
def test_the_center_of_pressure_of_drawn_loads_is_what_was_measured(walker, load):
    layout = walker.robot.layouts["left"]
    spread = LoadSpread(layout)
    hull = convex_hull(layout.positions[:, :2])
    points = np.random.default_rng(7).uniform(layout.outline.min(axis=0), layout.outline.max(axis=0), (100, 2))
    off = []
    for point in points:
        center = spread.forces(load, point) @ spread.places / load
        off.append(np.hypot(*(center - closest_point(hull, point))))
    assert max(off) < 1e-3
    assert np.median(off) < 1e-6


@pytest.mark.parametrize("load", [0.0, -5.0, float("nan")])
def test_a_sole_without_load_reads_nothing(walker, load):
    assert not LoadSpread(walker.robot.layouts["left"]).forces(load, (0.0, 0.0)).any()


def test_torques_of_the_stance_show_the_weight_and_where_it_is(walker):
    sensors = Sensors(0.0, walker.stance.angles, *REST, {}, torques=walker.stance.torques)
    readings = walker.soles.readings(sensors)
    weight = GRAVITY * walker.legs.mass
    for side in SIDES:
        force = readings[side].force
        assert force.sum() == pytest.approx(0.5 * weight, rel=0.02)
        middle = force @ walker.robot.layouts[side].positions[:, :2] / force.sum()
        assert middle == pytest.approx(walker.controller.middles[side], abs=0.01)


def test_an_ankle_that_carries_its_foot_alone_shows_no_load_and_one_that_stands_its_own():
    walker = load_controller("h1", soles="force_torque")
    for side, sensor in walker.controller.settings.ankles.items():
        up = np.array([0.0, 0.0, GRAVITY * sensor.mass])
        hanging = np.array([*-up, *-np.cross(sensor.com - sensor.position, up)])
        load = np.array([0.0, 0.0, 300.0])
        standing = hanging + np.concatenate([load, np.cross(-sensor.position, load)])  # 300 N at the sole's origin
        for wrench, expected in ((hanging, 0.0), (standing, 300.0)):
            sensors = Sensors(0.0, walker.stance.angles, *REST, {}, ankles={side: wrench})
            force = walker.soles.readings(sensors)[side].force
            assert force.sum() == pytest.approx(expected, abs=1.0)
            if expected:
                places = walker.robot.layouts[side].positions[:, :2]
                assert force @ places / force.sum() == pytest.approx([0.0, 0.0], abs=5e-3)


@pytest.mark.parametrize(
    "sensors",
    [
        Sensors(np.nan, np.zeros(12), *REST, {}, torques=np.zeros(12)),
        Sensors(0.0, np.zeros(11), *REST, {}, torques=np.zeros(12)),
        Sensors(0.0, np.zeros(12), *REST, {}, torques=np.full(12, np.nan)),
        Sensors(0.0, np.zeros(12), *REST, {}),
        Sensors(0.0, np.zeros(12), np.zeros(3), np.zeros(3), {}, torques=np.zeros(12)),
    ],
)
def test_sensors_that_report_nothing_give_no_reading(walker, sensors):
    assert walker.soles.readings(sensors) == {}
