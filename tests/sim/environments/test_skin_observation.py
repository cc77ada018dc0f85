"""Skin in the observation of an environment that is not ours."""

import numpy as np
import pytest

from plantar import InputError, grid_layout, laid_over
from plantar.mujoco import Skin
from plantar.sensing.taxel_faults import TaxelFaults

gymnasium = pytest.importorskip("gymnasium")
mujoco = pytest.importorskip("mujoco")

from plantar.sim.environments.skin_observation import SkinObservation  # noqa: E402

BOX = """<mujoco><worldbody><geom type="plane" size="2 2 .1"/><body name="box" pos="0 0 .1"><freejoint/>
<geom type="box" size=".1 .07 .1" mass="3"/></body></worldbody></mujoco>"""


class Falling(gymnasium.Env):
    """A box on a plane; nothing to do."""

    observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (7,))
    action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,))

    def __init__(self, model=True):
        if model:
            self.model = mujoco.MjModel.from_xml_string(BOX)
            self.data = mujoco.MjData(self.model)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        mujoco.mj_resetData(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)
        return self.data.qpos.astype(np.float32), {}

    def step(self, action):
        mujoco.mj_step(self.model, self.data, 10)
        return self.data.qpos.astype(np.float32), 0.0, False, False, {}


def test_the_skin_is_added_and_the_motion_stays():
    plain, worn = Falling(), SkinObservation(Falling(), {"pad": Skin(body="box")})
    plain.reset(seed=0)
    worn.reset(seed=0)
    for _ in range(60):
        a, b = plain.step(np.zeros(1))[0], worn.step(np.zeros(1))[0]
    assert np.array_equal(a, b["observation"])
    assert b in worn.observation_space
    assert b["pad"].sum() == pytest.approx(3 * 9.81, rel=0.01)
    assert worn.readings["pad"].carried


def test_two_wrappers_one_on_the_other():
    worn = SkinObservation(SkinObservation(Falling(), {"a": Skin(body="box")}), {"b": Skin(body="box", cell_area=1e-3)})
    assert set(worn.reset(seed=0)[0]) == {"observation", "a", "b"}


def test_what_a_curved_sole_reads_is_in_the_space():
    """The shear of a box that slides pulls along the axes of inclined taxels."""
    flat = grid_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]], pitch=(0.02, 0.02))
    curved = laid_over(flat, lambda x, y: 10.0 * (0.01 - x**2))
    worn = SkinObservation(Falling(), {"pad": Skin(curved, "box")})
    worn.reset(seed=0)
    worn.unwrapped.data.qvel[0] = 5.0
    seen = [worn.step(np.zeros(1))[0] for _ in range(10)]
    assert min(one["pad"].min() for one in seen) < 0.0
    assert all(one in worn.observation_space for one in seen)


def test_faults_are_drawn_by_the_seed():
    env = SkinObservation(Falling(), {"pad": Skin(body="box")}, TaxelFaults(offset=1.0, dead=0.1))
    a, b, c = (env.reset(seed=s)[0]["pad"] for s in (1, 1, 2))
    assert np.array_equal(a, b)
    assert not np.array_equal(a, c)


def test_what_has_no_model_and_names_that_are_taken_are_refused():
    with pytest.raises(InputError, match="MuJoCo's model"):
        SkinObservation(Falling(False), {"pad": Skin(body="box")})
    with pytest.raises(InputError, match="already has observation"):
        SkinObservation(Falling(), {"observation": Skin(body="box")})
    with pytest.raises(InputError, match="allowed: names and Skin objects"):
        SkinObservation(Falling(), {"pad": "box"})
    with pytest.raises(InputError, match="expected a TaxelFaults"):
        SkinObservation(Falling(), {"pad": Skin(body="box")}, 0.1)
