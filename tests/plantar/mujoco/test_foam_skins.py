"""Skin as an elastic foundation: Newton's third law, which taxels are loaded, weights, and what skipping changes."""

import pickle
import time
from functools import partial
from typing import Any

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError, RobotError, SceneError
from plantar.mujoco import Foam, FoamSkins, Skin, Skins
from plantar.sensing.link_skin import BodySkin
from plantar.sim.body_skin.electronics import SkinElectronics, SkinSensing
from plantar.sim.body_skin.surface import OBSTACLE_GROUP, skin_from_tables

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


def world(shape, place, thing="<freejoint/>", slab="", everything=False):
    model = mujoco.MjModel.from_xml_string(WORLD.format(shape=shape, place=place, thing=thing, slab=slab))
    skin = skin_from_tables(model, [TOP, BALL], "test")
    return model, mujoco.MjData(model), FoamSkins(model, skin, things(model), everything=everything)


def things(model: Any) -> list[int]:
    return np.flatnonzero(model.geom_group == OBSTACLE_GROUP).tolist()


def delivered(data: Any, sensor: FoamSkins, **settings: Any) -> Any:
    """What perfect electronics, or those of `settings`, read now."""
    electronics = SkinElectronics(sensor.body_skin, SkinSensing(**{**PERFECT, **settings}), 3)
    return electronics.read(float(data.time), lambda: sensor.whole(data))


def run(model: Any, data: Any, sensor: FoamSkins, steps: int) -> None:
    for _ in range(steps):
        mujoco.mj_step1(model, data)
        sensor.press(data)
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
        sensor.press(data)
        mujoco.mj_subtreeVel(model, data)
        momentum.append(data.subtree_linvel[0] * model.body_subtreemass[0])
        pressed = max(pressed, sensor.patch_force("top"))
        link = sensor.wrenches[sensor.body_skin.links.index("slab")]
        assert link[:3] == pytest.approx(-sensor.on_obstacles["thing"][:3], abs=1e-9)
        about_thing = link[3:] - np.cross(data.geom("thing").xpos - data.body("slab").xpos, link[:3])
        assert about_thing == pytest.approx(-sensor.on_obstacles["thing"][3:], abs=1e-9)
        mujoco.mj_step2(model, data)
    assert pressed > 5.0
    assert np.ptp(momentum, axis=0) == pytest.approx(0.0, abs=1e-3)  # of about 1 N s, and Euler steps


def test_a_static_weight_reads_its_weight():
    model, data, sensor = world(SHAPES[0], "0 0 .64")
    run(model, data, sensor, 1500)
    weight = 2.0 * -model.opt.gravity[2]
    assert sensor.patch_force("top") == pytest.approx(weight, rel=1e-3)
    assert sensor.patch_force("ball") == 0.0
    assert delivered(data, sensor).force.sum() == pytest.approx(weight, rel=1e-3)
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
    assert (delivered(data, sensor).force > 0.15).sum() == taxels
    assert sensor.force.sum() == pytest.approx(taxels * 691e-6 * 1e7 * 1e-3, rel=1e-6)


def test_a_probe_of_a_hundred_taxels():
    model, data, sensor = world('type="cylinder" size=".1482 .05"', "0 0 .6499", thing="")
    run(model, data, sensor, 3)
    assert (sensor.force > 0.0).sum() == pytest.approx(100, abs=5)


def test_proximity_is_the_distance_along_the_normal_within_range():
    model, data, sensor = world(SHAPES[0], "0 0 .67", thing="")
    run(model, data, sensor, 1)
    under = np.isfinite(sensor.distance)
    assert sensor.distance[under] == pytest.approx(0.03)
    assert delivered(data, sensor).distance[under] == pytest.approx(0.03, abs=1e-4)
    assert 12 <= under.sum() <= 24
    model, data, sensor = world(SHAPES[0], "0 0 .70", thing="")
    run(model, data, sensor, 1)
    assert not np.isfinite(delivered(data, sensor).distance).any()


@pytest.mark.parametrize("shape", SHAPES)
def test_skipping_changes_no_bit(shape):
    found = []
    for everything in (False, True):
        model, data, sensor = world(shape, "0.05 0.02 .70", slab="", everything=everything)
        data.qvel[:6] = [0.3, -0.1, -0.5, 1.0, 2.0, -1.0]
        electronics = SkinElectronics(sensor.body_skin, SkinSensing(), 3)
        readings = []
        for _ in range(250):
            run(model, data, sensor, 1)
            reading = electronics.read(float(data.time), partial(sensor.whole, data))
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
    run(model, data, FoamSkins(model, skin, things(model)), 500)
    assert data.ncon == 1
    assert data.body("thing").xpos[2] == pytest.approx(0.66, abs=0.003)


def test_a_world_without_the_link_is_refused():
    model, _data, sensor = world(SHAPES[0], "0 0 .65")
    other = mujoco.MjModel.from_xml_string("<mujoco/>")
    with pytest.raises(RobotError, match="the world has no link 'arm'"):
        FoamSkins(other, sensor.body_skin, [])
    assert model.nbody == 4


def test_a_step_with_nothing_near_is_cheap():
    model, data, sensor = world(SHAPES[0], "0 0 3.0")
    data.time = 0.001
    mujoco.mj_step1(model, data)
    best = min(_seconds(sensor, data) for _ in range(20))
    assert best < 100e-6
    assert sensor.cast == 0


def _seconds(sensor: FoamSkins, data: Any) -> float:
    begin = time.process_time()
    for _ in range(20):
        sensor.press(data)
    return (time.process_time() - begin) / 20


@pytest.mark.parametrize("shape", SHAPES)
def test_readings_are_those_of_any_skin_and_add_up(shape):
    """Patches' readings against the wrenches on links and obstacle, which are summed apart from them."""
    model, data, sensor = world(shape, "0.05 0.02 .638", slab="<freejoint/>")
    data.qvel[:6] = [0.1, 0.3, 0.2, 0.5, 0.0, 1.0]
    while sensor.force.max() < 0.1:
        run(model, data, sensor, 1)
    readings = sensor(data)
    for patch, reading in zip(sensor.body_skin.patches, readings, strict=True):
        inward = patch.rotations[:, :, 2]
        assert np.einsum("ij,ij->i", reading.vectors, inward) == pytest.approx(reading.force, abs=1e-12)
        assert reading.vectors.sum(axis=0) == pytest.approx(reading.wrench[:3], abs=1e-12)
        assert np.array_equal(reading.depth > 0.0, reading.distance < 0.0)
        link = sensor.wrenches[sensor.body_skin.links.index(patch.link)].reshape(2, 3)
        turn = data.body(patch.link).xmat.reshape(3, 3)
        assert (reading.wrench.reshape(2, 3) @ turn.T).ravel() == pytest.approx(link.ravel(), abs=1e-9)
        again = pickle.loads(pickle.dumps(reading))
        assert np.array_equal(again.wrench, reading.wrench)
    assert np.array_equal(sensor.whole(data).force, np.concatenate([r.force for r in readings]))


def test_without_friction_the_taxels_carry_the_wrench():
    model, _, sensor = world(SHAPES[1], "0.05 0.02 .659", thing="")
    data = mujoco.MjData(model)
    smooth = FoamSkins(model, sensor.body_skin, ["thing"], Foam(friction=0.0))
    run(model, data, smooth, 1)
    readings = {p.name: r for p, r in zip(smooth.body_skin.patches, smooth(data), strict=True)}
    assert readings["top"].force.sum() > 0.1
    assert readings["top"].carried
    assert not readings["ball"].wrench.any()


def test_a_skin_of_anybody_is_worn_as_foam():
    """A face's patch of `Skin`: a slab lights all of it, where contacts light what is at the slab's corners."""
    xml = """<mujoco><worldbody><geom type="plane" size="1 1 1"/><body name="box" pos="0 0 .2">
      <joint type="slide" axis="0 0 1" range="0 1"/><geom type="box" size=".1 .1 .1"/></body>
      <body name="lid" pos="0 0 .309"><joint type="slide" axis="0 0 1"/>
      <geom name="lid" type="box" size=".2 .2 .01" mass="3"/></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    model.jnt_range[0] = [0.0, 1.0]
    top = Skins([Skin(body="box", outward=(0, 0, 1)).bind(model)])
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    by_contacts = top(data)[0]
    foam = FoamSkins(model, top.body_skin, ["lid"])
    data = mujoco.MjData(model)
    run(model, data, foam, 500)
    (by_foam,) = foam(data)
    weight = 3.0 * 9.81
    assert by_contacts.force.sum() == pytest.approx(weight, rel=1e-3)
    assert by_foam.force.sum() == pytest.approx(weight, rel=1e-3)
    assert (by_foam.force > 0.1).all()
    assert 2 * (by_contacts.force > 0.1).sum() < len(by_foam.force)
    assert by_foam.depth.max() == pytest.approx(weight / foam.body_skin.areas.sum() / 1e7, rel=1e-2)


def test_a_height_field_presses_as_the_box_of_its_height():
    """A level height field and a box of the same face: the same depths."""
    found = []
    for shape in ('type="hfield" hfield="flat"', 'type="box" size=".4 .4 .05" pos="0 0 .049"'):
        xml = f"""<mujoco><asset><hfield name="flat" nrow="9" ncol="9" size=".4 .4 .1 .05"
          elevation="0 {" ".join(["1"] * 80)}"/></asset>
          <worldbody><geom name="ground" {shape}/><body name="foot" pos="0 0 .14"><freejoint/>
          <geom type="box" size=".1 .05 .042"/></body></worldbody></mujoco>"""
        model = mujoco.MjModel.from_xml_string(xml)
        if "hfield" not in shape:
            model.geom("ground").pos[2] = 0.05
        skin = Skins([Skin(body="foot", outward=(0, 0, -1)).bind(model)]).body_skin
        foam = FoamSkins(model, skin, ["ground"])
        data = mujoco.MjData(model)
        run(model, data, foam, 1)
        found.append(foam.depth)
    assert found[0] == pytest.approx(0.002, abs=1e-6)
    assert found[1] == pytest.approx(found[0], abs=1e-6)


@pytest.mark.parametrize("half", [0.003, 0.009, 0.03])
@pytest.mark.parametrize(
    "shape", ['pos="0 0 -.049" type="sphere" size=".05"', 'pos="0 0 -.019" type="box" size=".05 .05 .02"']
)
def test_what_presses_a_thin_plate_from_behind_is_not_felt_in_front(half, shape):
    xml = f"""<mujoco><worldbody><body name="plate"><joint type="slide" axis="1 0 0"/>
      <geom type="box" size=".06 .06 {half}" mass="1"/></body>
      <body mocap="true" pos="0 0 {-half}"><geom name="thing" {shape}/></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    found = []
    for way in (1, -1):
        patch = Skins([Skin(body="plate", outward=(0, 0, way), cell_area=1e-4).bind(model)]).body_skin
        foam = FoamSkins(model, patch, ["thing"])
        run(model, mujoco.MjData(model), foam, 1)
        found.append(foam.depth.max())
    assert found[0] == 0.0
    assert found[1] == pytest.approx(0.001, rel=0.05)


def test_what_is_wrong_is_refused_in_one_line():
    model, data, sensor = world(SHAPES[0], "0 0 .65")
    skin = sensor.body_skin
    with pytest.raises(InputError, match=r"call press\(data\) after mj_step1"):
        sensor(data)
    with pytest.raises(RobotError, match="no geom named 'thin'; did you mean thing"):
        FoamSkins(model, skin, ["thin"])
    with pytest.raises(RobotError, match="obstacle 'top' is a shape of 'slab', which has skin"):
        FoamSkins(model, skin, ["top"])
    with pytest.raises(InputError, match="obstacles"):
        FoamSkins(model, skin, "thing")
    with pytest.raises(InputError, match="stiffness"):
        Foam(stiffness=0.0)
    with pytest.raises(InputError, match=r"friction is -1\.0; allowed: 0 or more"):
        Foam(friction=-1.0)
    with pytest.raises(InputError, match="skin"):
        FoamSkins(model, [skin], ["thing"])  # type: ignore[arg-type]
    with pytest.raises(InputError, match="model is a MjData; expected a MjModel"):
        FoamSkins(data, skin, ["thing"])
    with pytest.raises(InputError, match="data is a MjModel; expected a MjData"):
        sensor.press(model)
    assert isinstance(skin, BodySkin)


def test_an_obstacle_of_a_kind_without_a_surface_is_refused():
    xml = """<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody>
      <geom name="sdf" type="sdf" mesh="m"/><body name="b"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    try:
        model = mujoco.MjModel.from_xml_string(xml)
    except ValueError:
        pytest.skip("this MuJoCo has no such geom without a plugin")
    skin = Skins([Skin(body="b", outward=(0, 0, 1)).bind(model)]).body_skin
    with pytest.raises(SceneError, match="of a kind that skin cannot measure"):
        FoamSkins(model, skin, ["sdf"])
