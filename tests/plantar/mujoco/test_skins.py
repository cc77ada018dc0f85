"""Several skins read in one call are as each of them alone."""

import pickle

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.mujoco import Skin, Skins

MODEL = """<mujoco><worldbody><geom type="plane" size="3 3 1"/><body name="trunk" pos="0 0 .3"><freejoint/>
  <geom type="box" size=".1 .15 .1" mass="20"/>
  <body name="right_foot" pos="0 -.1 -.28"><joint type="slide" axis="0 0 1" stiffness="20000" damping="600"/>
    <geom type="sphere" size=".01" pos=".08 .03 -.01" mass=".5"/><geom type="sphere" size=".01" pos=".08 -.03 -.01"/>
    <geom type="sphere" size=".01" pos="-.08 0 -.01" mass=".5"/></body>
  <body name="left_foot" pos="0 .1 -.28"><joint type="slide" axis="0 0 1" stiffness="20000" damping="600"/>
    <geom type="box" size=".1 .05 .02" mass="2"/></body></body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def worn():
    model = mujoco.MjModel.from_xml_string(MODEL)
    skins = [
        Skin(body="right_foot").bind(model),
        Skin(body="left_foot", proximity=0.05).bind(model),
        Skin(body="trunk", around=(0, 0, 1)).bind(model),
        Skin(body="left_foot", outward=(1, 0, 0), cell_area=1e-4).bind(model),
    ]
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 200)
    mujoco.mj_forward(model, data)
    return model, data, skins


def test_readings_are_those_of_each_skin(worn):
    _, data, skins = worn
    readings = Skins(skins)(data)
    assert [bool(r.wrench.any()) for r in readings] == [True, True, False, False]
    for reading, skin in zip(readings, skins, strict=True):
        alone = skin(data)
        assert reading.time == alone.time
        assert reading.carried == alone.carried
        for name in ("force", "vectors", "wrench", "depth", "distance"):
            assert np.array_equal(getattr(reading, name), getattr(alone, name))
    assert np.isfinite(readings[1].proximity).any()


def test_a_reading_stays_as_the_simulation_goes_on_and_can_be_pickled(worn):
    model, data, skins = worn
    both = Skins(skins)
    other = mujoco.MjData(model)
    mujoco.mj_step(model, other, 150)
    before = both(other)
    kept = before[0].vectors.copy()
    other.qpos[2] += 1.0
    mujoco.mj_forward(model, other)
    assert not any(reading.force.any() for reading in both(other))
    assert np.array_equal(before[0].vectors, kept)
    again = pickle.loads(pickle.dumps(before[0]))
    assert np.array_equal(again.vectors, kept)
    assert np.array_equal(again.wrench, before[0].wrench)
    copied = pickle.loads(pickle.dumps(both))
    assert np.array_equal(copied(data)[0].force, both(data)[0].force)


def test_the_whole_reading_is_in_the_order_of_the_body_skin(worn):
    _, data, skins = worn
    both = Skins(skins)
    body = both.body_skin
    reading = both.whole(data)
    assert [p.name for p in body.patches] == ["left_foot", "left_foot_2", "right_foot", "trunk"]
    assert len(reading.force) == len(body)
    readings = both(data)
    for name, index in (("right_foot", 0), ("left_foot", 1), ("trunk", 2), ("left_foot_2", 3)):
        own = body.slices[name]
        assert np.array_equal(reading.force[own], readings[index].force)
        assert np.array_equal(reading.distance[own], readings[index].distance)
        assert np.allclose(body.positions[own], skins[index].patch.positions)


def test_many_simulations_are_read_as_one_by_one(worn):
    model, _, skins = worn
    datas = [mujoco.MjData(model) for _ in range(5)]
    for steps, data in enumerate(datas):
        mujoco.mj_step(model, data, 40 * steps + 1)
    for skin, (vectors, wrenches) in zip(skins, Skins(skins).many(datas, threads=2), strict=True):
        alone = skin.many(datas)
        assert np.array_equal(vectors, alone[0])
        assert np.array_equal(wrenches, alone[1])


def test_a_simulation_that_diverged_reads_as_not_a_number(worn):
    model, _, skins = worn
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 200)
    mujoco.mj_forward(model, data)
    data.efc_force[:] = np.nan
    assert np.isnan(Skins(skins)(data)[0].force).all()


def test_what_is_no_skins_of_one_model_is_refused(worn):
    _, data, skins = worn
    with pytest.raises(InputError, match="empty"):
        Skins([])
    other = Skin(body="trunk").bind(mujoco.MjModel.from_xml_string(MODEL))
    with pytest.raises(InputError, match="several models"):
        Skins([skins[0], other])
    with pytest.raises(InputError, match="skin is"):
        Skins([Skin(body="trunk")])
    with pytest.raises(InputError, match=r"mujoco\.MjData"):
        Skins(skins)(1.0)
    assert len(Skins(skins)) == len(list(Skins(skins))) == 4
    assert not data.warning.number.any()
