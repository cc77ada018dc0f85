"""What is drawn of a skin."""

import mujoco
import numpy as np

from plantar.mujoco import Skin
from plantar.mujoco.overlay import draw_skin


def test_every_taxel_the_polygon_and_the_cop_are_drawn(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    scene = mujoco.MjvScene(model, maxgeom=500)
    mujoco.mj_forward(model, data)
    data.qpos[2] = 1.0
    mujoco.mj_forward(model, data)
    assert draw_skin(scene, feel, data) == len(feel)  # in the air: no polygon, no centre of pressure
    data.qpos[2] = 0.0199
    mujoco.mj_step(model, data, 100)
    added = draw_skin(scene, feel, data)
    corners = len(feel.percept(data).support_polygon_in_sole)
    assert added == len(feel) + corners + 1
    assert corners >= 3
    cop = feel.pose(data).to_world([*feel(data).position_cop_in_sole, 0.0])
    assert np.allclose(scene.geoms[scene.ngeom - 1].pos, cop, atol=1e-6)
    assert scene.geoms[len(feel)].rgba[0] > 0.0
    small = mujoco.MjvScene(model, maxgeom=5)
    assert draw_skin(small, feel, data) == 5
