"""The kernel of a patch that wraps: compiled against interpreted, on geoms of all kinds at once."""

import mujoco
import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.contacts import foot_contacts, patch_load
from plantar.kernels.contacts.foot_contacts import ContactsInSole, FootContacts
from plantar.kernels.contacts.patch_load import PatchLoad
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
    kernel = Skin(body="limb", **way).bind(model).wraps
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


def shared(places, areas, force):
    """The load of one contact at the origin, on flat cells about it that reach 1 m."""
    count = len(places)
    normals = np.tile([0.0, 0.0, 1.0], (count, 1))
    limits = np.array([0.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 2.0, *[-np.inf] * 3, *[np.inf] * 3])
    sphere = int(mujoco.mjtGeom.mjGEOM_SPHERE)
    load = PatchLoad(
        places, normals, areas, 1.0, np.array([0], dtype=np.int32), np.array([sphere], dtype=np.int32),
        np.array([[0.0, 0.0, 0.0, *np.eye(3).ravel()]]), np.full((1, 3), 0.1), np.zeros(2, dtype=np.int32),
        np.zeros((0, 4)), limits, np.zeros((0, 2)), np.eye(3),
    )  # fmt: skip
    contacts = FootContacts(np.ones(1, dtype=np.uint8))
    vectors = np.array([[0.0, 0.0, 0.0], force, [0.0, 0.0, 0.0]])
    contacts.take(np.zeros((1, 2), dtype=np.int32), vectors, np.array([0.0]), np.array([1], dtype=np.uint8))
    np.asarray(contacts.normals)[0] = [0.0, 0.0, 1.0]
    seen = ContactsInSole()
    seen.look_from(np.zeros(3), np.eye(3))
    load.press(contacts, seen, 1e-3)
    return load


def test_a_touch_that_only_three_cells_can_carry_keeps_its_center():
    """From Baxter's wrist: Newton's second step leaves one cell loaded, which alone determines no tilt."""
    places = np.array([
        [-0.148260674, 0.150173836, 0], [0.431497537, 0.540451643, 0], [0.214990744, -0.046794531, 0],
        [-0.337399455, 0.869364199, 0], [-0.865680014, -0.162230332, 0],
    ])  # fmt: skip
    weights = np.array([0.609229322, 0.175485603, 0.070983243, 0.042258334, 0.102043498])
    load = shared(places, weights / (1.0 - (places**2).sum(axis=1)), [1.0, 2.0, 10.0])
    part = load.vectors[:, 2] / 10.0
    assert np.flatnonzero(part).tolist() == [0, 2, 4]
    assert np.abs(part @ places).max() < 1e-11
    assert np.abs(load.vectors.sum(axis=0) - [1.0, 2.0, 10.0]).max() < 1e-12


def test_drawn_cells_about_a_touch_keep_its_center():
    rng = np.random.default_rng(4)
    tried = 0
    for _ in range(300):
        count = int(rng.integers(3, 9))
        turns = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
        if np.diff([*turns, turns[0] + 2.0 * np.pi]).max() > 3.1:
            continue  # not on all sides
        tried += 1
        places = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(count)]) * rng.uniform(0.02, 0.99, (count, 1))
        load = shared(places, rng.uniform(0.1, 1.0, count), [0.0, 0.0, 1.0])
        assert np.abs(load.vectors[:, 2] @ places).max() < 1e-10
        assert (load.vectors[:, 2] >= 0.0).all()
    assert tried > 100
