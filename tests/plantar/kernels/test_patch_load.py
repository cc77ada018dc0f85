"""The kernel of a patch that wraps: compiled against interpreted, on geoms of all kinds at once."""

import mujoco
import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts import foot_contacts, patch_load
from plantar.mujoco import Skin

MESH = '<mesh name="m" vertex="-.1 -.05 0 .1 -.05 0 .12 .04 0 -.1 .05 0 -.08 0 .06 .05 0 .05"/>'
MODEL = f"""<mujoco><asset>{MESH}</asset><worldbody><body name="limb"><freejoint/><geom type="box" size=".05 .04 .03"/>
  <geom size=".04" pos=".2 0 0"/><geom type="capsule" size=".03 .05" pos="0 .2 0" euler="30 40 0"/>
  <geom type="cylinder" size=".04 .05" pos="-.2 0 0" euler="0 50 10"/><geom type="mesh" mesh="m" pos="0 -.2 0"/>
  <geom type="ellipsoid" size=".05 .03 .04" pos="0 0 .2"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    "way",
    [
        {"around": (0, 0, 1)},
        {"outward": (1, 0.2, 0.1), "within": 89, "region": ((-1, -1, -0.02), (1, 1, 1))},
        {"outward": (0, 0, 1), "polygon": [(-0.3, -0.3), (0.3, -0.2), (0.2, 0.3)]},
    ],
)
def test_compiled_form_is_the_interpreted_one(way):
    model = mujoco.MjModel.from_xml_string(MODEL)
    kernel = Skin(body="limb", **way).bind(model).make_load.__self__.kernel
    rng = np.random.default_rng(4)
    own = np.ones(model.ngeom + 1, dtype=np.uint8)
    own[-1] = 0
    contacts = 40
    centers = np.array([model.geom_pos[g] for g in range(model.ngeom)])
    geoms = np.column_stack([rng.integers(0, model.ngeom, contacts), np.full(contacts, model.ngeom)]).astype(np.int32)
    frames = np.array([np.linalg.qr(rng.normal(size=(3, 3)))[0].ravel() for _ in range(contacts)])
    places = centers[geoms[:, 0]] + 0.04 * frames[:, :3]
    addresses = (3 * np.arange(contacts)).astype(np.int32)
    sizes = np.full(contacts, 3, dtype=np.int32)
    listed = geoms, places, frames, rng.uniform(-1e-3, 0.0, contacts), addresses, sizes
    forces = rng.normal(size=3 * contacts)
    found = []
    for part, shapes in ((patch_load, foot_contacts), tuple(python_form(n) for n in ("patch_load", "foot_contacts"))):
        foot = shapes.FootContacts(own)
        seen = shapes.ContactsInSole()
        load = part.PatchLoad(*kernel)
        shapes.gather_feet((foot,), shapes.ContactList(*listed), forces)
        load.press(foot, seen, 5e-4)
        found.append((load.vectors, load.forces, load.depths, load.wrench))
        assert load.touched
    for one, other in zip(*found, strict=True):
        assert np.array_equal(one, other)
        assert one.any()
    assert np.abs(found[0][0].sum(axis=0) - found[0][3][:3]).max() < 1e-12 * np.abs(forces).sum()
