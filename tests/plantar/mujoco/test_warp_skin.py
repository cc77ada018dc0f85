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

spec = importlib.util.spec_from_file_location("warp_skin_models", Path(__file__).with_name("conftest.py"))
models = importlib.util.module_from_spec(spec)
spec.loader.exec_module(models)
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


def test_a_patch_that_wraps_is_refused():
    feel = Skin(body="foot", outward=(0, 0, -1)).bind(mujoco.MjModel.from_xml_string(models.box()))
    with pytest.raises(InputError, match="patch that wraps"):
        WarpSkin(feel, 2)


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
