"""Skin in the worlds of MuJoCo Warp, on the CPU, against `BoundSkin`."""

import importlib.util
from pathlib import Path

import mujoco
import numpy as np
import pytest

from plantar import InputError
from plantar.mujoco import ElasticLayer, Skin
from plantar.mujoco.warp_skin import WarpSkin
from plantar.sensing.taxel_faults import TaxelFaults

wp = pytest.importorskip("warp")
mjw = pytest.importorskip("mujoco_warp")


def beside(name):
    """A module of this folder."""
    spec = importlib.util.spec_from_file_location(f"warp_skin_{name}", Path(__file__).with_name(f"{name}.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


models = beside("conftest")
wrapped = beside("test_wrapped_skin")
MODELS = {
    **models.KINDS,
    "load on the back": models.STACK,
    "geom that sticks": models.box().replace("condim=", 'adhesion="5" condim='),
}
pytestmark = [pytest.mark.long, pytest.mark.filterwarnings("ignore")]  # compiles for a minute


@pytest.mark.parametrize("text", MODELS.values(), ids=MODELS)
def test_forces_are_those_of_the_skin(text):
    model = mujoco.MjModel.from_xml_string(text)
    data, feel = mujoco.MjData(model), Skin(body="foot").bind(model)
    many = WarpSkin(feel, 2)
    for _ in range(3):
        mujoco.mj_step(model, data, 60)
        mujoco.mj_forward(model, data)
        many.read(mjw.put_data(model, data, nworld=2))
        vectors, wrench, carried = many.numpy()
        reading = feel(data)
        size = max(np.linalg.norm(reading.wrench[:3]), 1.0)
        assert np.abs(wrench - reading.wrench).max() < 1e-5 * size
        assert np.abs(vectors - reading.vectors).max() < 1e-5 * size
        assert (carried == reading.carried).all()


def test_worlds_are_read_apart_and_their_number_is_checked():
    model = mujoco.MjModel.from_xml_string(models.box())
    data, feel = mujoco.MjData(model), Skin(body="foot").bind(model)
    mujoco.mj_step(model, data, 200)
    mujoco.mj_forward(model, data)
    worlds = mjw.put_data(model, data, nworld=3)
    force = worlds.efc.force.numpy()
    force[1] *= 2.0
    worlds.efc.force.assign(force)
    many = WarpSkin(feel, 3)
    many.read(worlds)
    loads = many.numpy()[1][:, 2]
    assert loads == pytest.approx(feel(data).wrench[2] * np.array([1.0, 2.0, 1.0]), rel=1e-5)
    worlds.efc.force.assign(np.where(np.arange(3)[:, None] == 1, np.nan, force))  # world 1 diverged
    many.read(worlds)
    assert np.isnan(many.numpy()[0]).any(axis=(1, 2)).tolist() == [False, True, False]
    worlds.efc.force.assign(force)
    few = WarpSkin(feel, 3, contacts=2)
    few.read(worlds)
    assert not few.numpy()[2].any()
    with pytest.raises(InputError, match="3 worlds; the skin was made for 2"):
        WarpSkin(feel, 2).read(worlds)


def test_constraints_that_have_no_room_carry_nothing():
    model = mujoco.MjModel.from_xml_string(models.box(6))
    feel = Skin(body="foot").bind(model)
    worlds, many = mjw.put_data(model, mujoco.MjData(model), nworld=2, njmax=32), WarpSkin(feel, 2)
    for _ in range(30):
        mjw.step(mjw.put_model(model), worlds)
    many.read(worlds)
    count, force = worlds.nacon.numpy()[0], worlds.efc.force.numpy()
    loads = np.zeros(2)
    for world, rows in zip(
        worlds.contact.worldid.numpy()[:count], worlds.contact.efc_address.numpy()[:count], strict=True
    ):
        loads[world] += force[world, rows[rows >= 0]].sum()
    assert (rows < 0).any()
    assert many.numpy()[1][:, 2] == pytest.approx(loads, rel=1e-5)


WAYS = {
    "by direction": {"outward": (1, 0, 0)},
    "round an axis": {"around": (0, 0, 1)},
    "half of it": {"outward": (1, 0.3, 0), "within": 100.0, "region": ((-1, -1, -1), (1, 1, 0.015))},
    "drawn": {"outward": (1, 0, 0), "polygon": [(-0.04, -0.03), (0.04, -0.03), (0.04, 0.04)]},
}


@pytest.mark.parametrize("kind", wrapped.KINDS)
def test_patches_that_wrap_are_those_of_the_skin(kind):
    """A mesh that presses from four sides at three heights on a turned body."""
    model = wrapped.scene(wrapped.KINDS[kind], wrapped.TURNED, extra=wrapped.PROBE.format(wrapped.BALL))
    feels = [Skin(body="body", **way).bind(model) for way in WAYS.values()]
    many = [WarpSkin(feel, 2) for feel in feels]
    touched = np.zeros(len(WAYS), dtype=int)
    for degrees in (8.0, 30.0, 95.0, 180.0):
        for height in (0.0, 0.01, 0.02):
            data = wrapped.touch(model, degrees, height)
            worlds = mjw.put_data(model, data, nworld=2)
            for i, (feel, one) in enumerate(zip(feels, many, strict=True)):
                one.read(worlds)
                vectors, wrench, carried = one.numpy()
                reading = feel(data)
                load = max(float(np.linalg.norm(reading.wrench[:3])), 1.0)
                assert np.abs(vectors - reading.vectors).max() < 1e-5 * load
                assert np.abs(wrench - reading.wrench).max() < 1e-5 * load
                assert (carried == reading.carried).all()
                touched[i] += reading.vectors.any()
    assert (touched > 0).all()
    assert (touched[[0, 2, 3]] < 12).all()  # round the axis all touches are on the patch


def test_a_patch_has_layer_and_faults_and_knows_worlds_apart():
    ground = '<geom type="plane" size="3 3 1" pos="0 0 .95"/>'
    model = wrapped.scene(wrapped.KINDS["box"], ground=ground, gravity="0 0 -9.81")
    faults = TaxelFaults(gain=0.15, hysteresis=0.05, creep=0.05, noise=0.1, saturation=60.0, dead_band=0.2)
    below = {"body": "body", "outward": (0, 0, -1), "layer": ElasticLayer(1e6, 0.05)}
    feel = Skin(**below, faults=faults, seed=2).bind(model)
    soft = Skin(**below).bind(model)
    many = WarpSkin(feel, 3)
    worn = faults.worn(feel.layout, 2, (3,))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 100)
    mujoco.mj_forward(model, data)
    worlds = mjw.put_data(model, data, nworld=3)
    force = worlds.efc.force.numpy()
    force[1] *= 2.0
    force[2] = np.nan  # diverged
    worlds.efc.force.assign(force)
    many.read(worlds)
    vectors, _, carried = many.numpy()
    truth = soft(data)
    assert truth.vectors.any()
    assert np.abs(vectors[0] - truth.vectors).max() < 1e-5 * truth.wrench[2]
    assert np.abs(vectors[1] - 2.0 * truth.vectors).max() < 1e-5 * truth.wrench[2]
    assert np.isnan(vectors[2]).all()
    assert carried[0] == truth.carried
    sound = vectors.copy()
    sound[2] = 0.0
    expected = worn.read(data.time, np.einsum("wij,ij->wi", sound, feel.static[1]), sound)
    expected[2] = np.nan
    assert np.array_equal(many.force(data.time), expected, equal_nan=True)


def test_layer_and_faults_are_those_of_the_skin():
    model = mujoco.MjModel.from_xml_string(models.box())
    layer = ElasticLayer(1e6, 0.05)
    faults = TaxelFaults(0.1, 0.5, 0.3, 0.1, 0.15, 0.1, 0.2, 0.03, 0.02, 0.013, 0.01, 0.1, 30.0, 0.2, 0.1, 0.2)
    feel = Skin(body="foot", layer=layer, faults=faults, seed=3).bind(model)
    soft = Skin(body="foot", layer=layer).bind(model)
    many = WarpSkin(feel, 3)
    worn = faults.worn(feel.layout, 3, (3,))
    data = mujoco.MjData(model)
    for _ in range(4):
        mujoco.mj_step(model, data, 40)
        mujoco.mj_forward(model, data)
        many.read(mjw.put_data(model, data, nworld=3))
        truth = soft(data)
        load = max(float(np.linalg.norm(truth.wrench[:3])), 1.0)
        vectors, _, carried = many.numpy()
        assert np.abs(vectors - truth.vectors).max() < 1e-5 * load
        assert (carried == truth.carried).all()
        along = np.einsum("wij,ij->wi", vectors, feel.static[1])
        # The same draws, on forces that differ by MuJoCo Warp's float32 alone.
        assert np.array_equal(many.force(data.time), worn.read(data.time, along, vectors), equal_nan=True)
