"""Elements are deleted while the model's own list of them shrinks."""

import mujoco

from plantar.mujoco.deletion import delete_all


def test_all_are_deleted():
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body()
    for _ in range(4):
        body.add_geom(size=[0.1, 0, 0])
    delete_all(spec, body.geoms)
    assert spec.compile().ngeom == 0
