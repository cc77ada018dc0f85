"""The skin as a sensor in an mjlab scene, on the CPU, against `BoundSkin` and MuJoCo Warp's contacts."""

import warnings

import mujoco
import numpy as np
import pytest

from plantar.errors import RobotError

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    pytest.importorskip("mjlab.scene")
pytestmark = [pytest.mark.long, pytest.mark.filterwarnings("ignore")]  # compiles for minutes

import mujoco_warp  # noqa: E402
from mjlab.entity import EntityCfg  # noqa: E402
from mjlab.scene import Scene, SceneCfg  # noqa: E402
from mjlab.sim import MujocoCfg, Simulation, SimulationCfg  # noqa: E402

from plantar.mujoco import ElasticLayer  # noqa: E402
from plantar.mujoco.mjlab_sensor import SkinSensorCfg  # noqa: E402
from plantar.sensing.taxel_faults import TaxelFaults  # noqa: E402

FEET = """<mujoco><worldbody><body name="trunk" pos="0 0 .3"><freejoint name="base"/>
  <geom type="box" size=".1 .15 .1" mass="20"/>
  <body name="left_foot" pos="0 .1 -.28">
    <joint name="left" type="slide" axis="0 0 1" stiffness="20000" damping="600"/>
    <geom type="box" size=".1 .05 .02" mass="2"/></body>
  <body name="right_foot" pos="0 -.1 -.28">
    <joint name="right" type="slide" axis="0 0 1" stiffness="20000" damping="600"/>
    <geom type="sphere" size=".01" pos=".08 .03 -.01" mass=".5"/><geom type="sphere" size=".01" pos=".08 -.03 -.01"/>
    <geom type="sphere" size=".01" pos="-.08 0 -.01" mass=".5"/></body></body></worldbody></mujoco>"""
FLOOR = '<mujoco><worldbody><geom type="plane" size="5 5 1"/></worldbody></mujoco>'


def make_scene(worlds, bodies=("left_foot", "right_foot"), cone="pyramidal", patches=None):
    entities = {
        "floor": EntityCfg(spec_fn=lambda: mujoco.MjSpec.from_string(FLOOR)),
        "robot": EntityCfg(spec_fn=lambda: mujoco.MjSpec.from_string(FEET)),
    }
    soles = [SkinSensorCfg(name=body, entity="robot", body=body) for body in bodies]
    wrapped = [
        SkinSensorCfg(name=name, entity="robot", body="left_foot", options=way) for name, way in (patches or {}).items()
    ]
    sensors = (*soles, *wrapped)
    scene = Scene(SceneCfg(num_envs=worlds, entities=entities, sensors=sensors), device="cpu")
    sim = Simulation(worlds, SimulationCfg(mujoco=MujocoCfg(cone=cone)), scene.compile(), device="cpu")
    scene.initialize(sim.mj_model, sim.model, sim.data)
    return scene, sim


@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_an_mjlab_scene_has_the_skins_data(cone):
    scene, sim = make_scene(3, cone=cone)
    for _ in range(300):
        sim.step()
        scene.update(sim.mj_model.opt.timestep)
    weight = 9.81 * sim.mj_model.body_mass.sum()
    total = np.zeros(3)
    for name in ("left_foot", "right_foot"):
        sensor = scene[name]
        assert tuple(sensor.data.shape) == (3, len(sensor.skin.layout), 3)
        assert str(sensor.wrench.dtype) == str(sensor.data.dtype) == "torch.float32"  # as all else that a policy sees
        sums = sensor.data.sum(dim=1).numpy()
        assert np.allclose(sums, sensor.wrench.numpy()[:, :3], atol=1e-5 * weight)
        assert sensor.carried.all()
        total += sums[:, 2]
    assert np.allclose(total, weight, rtol=0.02)
    before = scene["left_foot"].data.clone()
    sim.data.qvel[1, 2] = -1.0  # world 1 is hit
    sim.step()
    assert np.array_equal(scene["left_foot"].data, before)  # until the scene's update
    scene.update(sim.mj_model.opt.timestep)
    after = scene["left_foot"].data[:, :, 2].sum(dim=1)
    assert after[1] > 1.5 * after[0]


def test_its_forces_are_those_of_the_skin_in_mujoco():
    scene, sim = make_scene(2)
    model, data = sim.mj_model, mujoco.MjData(sim.mj_model)
    mujoco.mj_step(model, data, 200)
    mujoco.mj_forward(model, data)
    worlds = mujoco_warp.put_data(model, data, nworld=2)
    for name in ("left_foot", "right_foot"):
        sensor = scene[name]
        sensor.initialize(model, sim.model, worlds, "cpu")
        sensor.reset()
        reading = sensor.skin(data)
        assert np.abs(sensor.data.numpy() - reading.vectors).max() < 1e-5 * reading.wrench[2]
        assert np.abs(sensor.wrench.numpy() - reading.wrench).max() < 1e-5 * reading.wrench[2]


def test_patches_that_wrap_have_layer_and_faults_too():
    layer = {"layer": ElasticLayer(1e6, 0.02), "faults": TaxelFaults(gain=0.15, dead_band=0.2), "seed": 4}
    patches = {
        "below": {"outward": (0, 0, -1)},
        "soft": {"outward": (0, 0, -1), **layer},
        "top": {"outward": (0, 0, 1)},
    }
    scene, sim = make_scene(2, patches=patches)
    model, data = sim.mj_model, mujoco.MjData(sim.mj_model)
    mujoco.mj_step(model, data, 200)
    mujoco.mj_forward(model, data)
    worlds = mujoco_warp.put_data(model, data, nworld=2)
    for name in patches:
        sensor = scene[name]
        sensor.initialize(model, sim.model, worlds, "cpu")
        sensor.reset()
        reading = sensor.skin(data)
        load = max(float(np.linalg.norm(reading.wrench[:3])), 1.0)
        assert reading.vectors.any() == (name != "top")
        assert np.abs(sensor.data.numpy() - reading.vectors).max() < 1e-5 * load
        assert np.abs(sensor.wrench.numpy() - reading.wrench).max() < 1e-5 * load
    soft = scene["soft"]
    along = np.einsum("ij,ij->i", soft.skin(data).vectors, soft.skin.static[1])
    worn = soft.skin.faults.worn(soft.skin.layout, 4, (2,)).read(0.0, np.tile(along, (2, 1)))
    assert np.allclose(soft.force.numpy(), worn, atol=1e-4 * along.sum(), equal_nan=True)


def test_a_body_that_is_missing_is_named():
    with pytest.raises(RobotError, match="no body named 'robot/left_fot'; did you mean robot/left_foot"):
        make_scene(1, ("left_fot",))
