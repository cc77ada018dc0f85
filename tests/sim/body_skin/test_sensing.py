"""Skin as an elastic foundation: Newton's third law, which taxels are loaded, weights, and what skipping changes."""

import time
from typing import Any

import mujoco
import numpy as np
import pytest

from plantar.errors import RobotError
from plantar.sim.body_skin.electronics import SkinElectronicsSettings
from plantar.sim.body_skin.sensing import SkinSensing, SkinSensor
from plantar.sim.body_skin.surface import skin_from_tables

WORLD = """
<mujoco>
  <option timestep=".001"/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 1"/>
    <body name="slab" pos="0 0 .5">{slab}
      <geom name="top" type="box" size=".3 .3 .1" mass="20"/>
      <body name="arm" pos="0 0 -.2"><geom type="sphere" size=".05"/></body>
    </body>
    <body name="thing" pos="{place}">{thing}<geom name="thing" {shape} group="3" mass="2"/></body>
  </worldbody>
</mujoco>"""
TOP = {"name": "top", "link": "slab", "position": [0, 0, 0.1], "rotation": [180, 0, 0], "size": [0.5, 0.5]}
BALL = {"name": "ball", "link": "arm", "position": [0, 0, -0.05], "size": [0.05, 0.05]}
PERFECT = {"noise": 0.0, "gain_error": 0.0, "bits": 24}


def world(shape, place, thing="<freejoint/>", slab="", **settings):
    model = mujoco.MjModel.from_xml_string(WORLD.format(shape=shape, place=place, thing=thing, slab=slab))
    skin = skin_from_tables(model, [TOP, BALL], "test")
    return model, mujoco.MjData(model), SkinSensor(model, skin, SkinSensing(**settings), 3)


def run(model: Any, data: Any, sensor: SkinSensor, steps: int) -> None:
    for _ in range(steps):
        mujoco.mj_step1(model, data)
        sensor.apply(data)
        mujoco.mj_step2(model, data)


SHAPES = [
    'type="box" size=".06 .05 .04"',
    'type="sphere" size=".06"',
    'type="capsule" size=".04 .08" euler="20 80 0"',
    'type="cylinder" size=".05 .04"',
    'type="ellipsoid" size=".08 .06 .05"',
]


@pytest.mark.parametrize("shape", SHAPES)
def test_obstacle_and_robot_feel_the_same_force_reversed(shape):
    model, data, sensor = world(shape, "0.05 0.02 .638", slab="<freejoint/>")
    data.qvel[:6] = [0.1, 0.3, 0.2, 0.5, 0.0, 1.0]
    data.qvel[-6:] = [0.3, -0.1, -0.4, 1.0, 2.0, -1.0]
    model.opt.gravity[:] = 0.0
    momentum = []
    pressed = 0.0
    for _ in range(60):
        mujoco.mj_step1(model, data)
        sensor.apply(data)
        mujoco.mj_subtreeVel(model, data)
        momentum.append(data.subtree_linvel[0] * model.body_subtreemass[0])
        pressed = max(pressed, sensor.patch_force("top"))
        link = sensor.wrenches[sensor.skin.links.index("slab")]
        assert link[:3] == pytest.approx(-sensor.on_obstacles["thing"][:3], abs=1e-9)
        about_thing = link[3:] - np.cross(data.geom("thing").xpos - data.body("slab").xpos, link[:3])
        assert about_thing == pytest.approx(-sensor.on_obstacles["thing"][3:], abs=1e-9)
        mujoco.mj_step2(model, data)
    assert pressed > 5.0
    assert np.ptp(momentum, axis=0) == pytest.approx(0.0, abs=1e-3)  # of about 1 N s, and Euler steps


def test_a_static_weight_reads_its_weight():
    model, data, sensor = world(SHAPES[0], "0 0 .64", **PERFECT)
    run(model, data, sensor, 1500)
    weight = 2.0 * -model.opt.gravity[2]
    assert sensor.patch_force("top") == pytest.approx(weight, rel=1e-3)
    assert sensor.patch_force("ball") == 0.0
    assert sensor.read(data).force.sum() == pytest.approx(weight, rel=1e-3)
    assert np.abs(data.body("thing").cvel).max() < 1e-3
    assert data.ncon == 0


def test_friction_holds_what_is_pushed_less_than_it_and_lets_go_of_more():
    model, data, sensor = world(SHAPES[0], "0 0 .639")
    run(model, data, sensor, 300)
    for share, moves in ((0.5, False), (2.0, True)):
        data.qfrc_applied[0] = share * 0.5 * 2.0 * 9.81
        begin = data.qpos[0]
        run(model, data, sensor, 150)
        assert (data.qpos[0] - begin > 0.02) == moves


@pytest.mark.parametrize(("taxels", "radius"), [(1, 0.012), (7, 0.031)])
def test_a_probe_loads_the_taxels_that_it_covers(taxels, radius):
    model, data, sensor = world(f'type="cylinder" size="{radius} .05"', "0 0 .649", thing="")
    run(model, data, sensor, 3)
    assert (sensor.force > 0.0).sum() == taxels
    assert (sensor.read(data).force > 0.15).sum() == taxels
    assert sensor.force.sum() == pytest.approx(taxels * 691e-6 * 1e7 * 1e-3, rel=1e-6)


def test_a_probe_of_a_hundred_taxels():
    model, data, sensor = world('type="cylinder" size=".1482 .05"', "0 0 .6499", thing="")
    run(model, data, sensor, 3)
    assert (sensor.force > 0.0).sum() == pytest.approx(100, abs=5)


def test_proximity_is_the_distance_along_the_normal_within_range():
    model, data, sensor = world(SHAPES[0], "0 0 .67", thing="", **PERFECT)
    run(model, data, sensor, 1)
    under = np.isfinite(sensor.distance)
    assert sensor.distance[under] == pytest.approx(0.03)
    assert sensor.read(data).distance[under] == pytest.approx(0.03, abs=1e-4)
    assert 12 <= under.sum() <= 24
    model, data, sensor = world(SHAPES[0], "0 0 .70", thing="", **PERFECT)
    run(model, data, sensor, 1)
    assert not np.isfinite(sensor.read(data).distance).any()


@pytest.mark.parametrize("shape", SHAPES)
def test_skipping_changes_no_bit(shape):
    found = []
    for everything in (False, True):
        model, data, sensor = world(shape, "0.05 0.02 .70", slab="", everything=everything)
        data.qvel[:6] = [0.3, -0.1, -0.5, 1.0, 2.0, -1.0]
        readings = []
        for _ in range(250):
            run(model, data, sensor, 1)
            reading = sensor.read(data)
            readings.append(np.concatenate([reading.force, reading.distance, data.qpos]))
        found.append((np.array(readings), sensor.skipped))
    assert np.array_equal(found[0][0], found[1][0])
    assert found[0][0][:, :300].max() > 0.0
    assert found[1][1] == 0 < found[0][1]


def test_a_link_without_skin_touches_obstacles_by_contacts():
    xml = WORLD.format(shape=SHAPES[1], place="0 0 .655", thing="<freejoint/>", slab="")
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    skin = skin_from_tables(model, [BALL], "test")
    run(model, data, SkinSensor(model, skin, SkinSensing(), 0), 500)
    assert data.ncon == 1
    assert data.body("thing").xpos[2] == pytest.approx(0.66, abs=0.003)


def test_readings_have_rate_delay_gain_errors_and_dead_taxels():
    _model, data, sensor = world(SHAPES[0], "0 0 .649", dead_taxels=0.1, delay_periods=2, noise=0.0, rate=100.0)
    force = np.full(len(sensor.skin), 10.0)
    told = []
    for step in range(50):
        data.time = 0.001 * step
        sensor.force[:] = force * (1.0 + step)
        told.append(sensor.read(data))
    assert [r.time for r in told[::10]] == pytest.approx([0.0, 0.0, 0.0, 0.01, 0.02])
    assert np.isnan(told[0].force).sum() == round(0.1 * len(sensor.skin))
    spread = np.nanstd(told[0].force / 10.0)
    assert 0.02 < spread < 0.08
    assert SkinElectronicsSettings().bits == 10


def test_a_world_without_the_link_is_refused():
    model, _data, sensor = world(SHAPES[0], "0 0 .65")
    other = mujoco.MjModel.from_xml_string("<mujoco/>")
    with pytest.raises(RobotError, match="the world has no link 'arm'"):
        SkinSensor(other, sensor.skin, SkinSensing(), 0)
    assert model.nbody == 4


def test_a_step_with_nothing_near_is_cheap():
    model, data, sensor = world(SHAPES[0], "0 0 3.0")
    data.time = 0.001
    mujoco.mj_step1(model, data)
    best = min(_seconds(sensor, data) for _ in range(20))
    assert best < 100e-6
    assert sensor.cast == 0


def _seconds(sensor: SkinSensor, data: Any) -> float:
    begin = time.process_time()
    for _ in range(20):
        sensor.apply(data)
    return (time.process_time() - begin) / 20
