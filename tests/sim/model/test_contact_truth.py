"""Contact truth against Newton's laws, statics and hand-made contacts."""

from typing import Any

import mujoco
import numpy as np
import pytest

from plantar.geometry.polygon import area, signed_margin
from plantar.sim.model.contact_truth import (
    ContactSet,
    FootContacts,
    contact_wrench_in_frame,
    contact_wrench_in_world,
    feet_contacts,
    foot_contacts,
    ground_truth,
    support_polygon_of_contacts,
)

GRAVITY = 9.81
MASS = 43.0


def foot_model(floor: str, *, first: bool = False, com: str = "0 0 0.2", condim: int = 3) -> Any:
    """A free foot of 43 kg over a floor; `first` puts the foot before the floor, so that it is geom 1."""
    foot = f"""<body name="left_foot" pos="0 0 0.0101"><freejoint/>
        <inertial pos="{com}" mass="{MASS}" diaginertia="2 2 1"/>
        <geom name="left_sole_box" type="box" size="0.125 0.0775 0.01" condim="{condim}"/>
        <site name="left_sole" pos="0 0 -0.01"/></body>"""
    body = f"<body name='ground'>{floor}</body>"
    inner = foot + body if first else body + foot
    return mujoco.MjModel.from_xml_string(
        f"<mujoco><option timestep='0.001' cone='elliptic'/><worldbody>{inner}</worldbody></mujoco>"
    )


PLANE = "<geom name='floor' type='plane' size='2 2 0.1'/>"
BLOCK = "<geom name='floor' type='box' size='2 2 0.1' pos='0 0 -0.1'/>"


def settled(model: Any, seconds: float = 0.6, push: tuple[float, ...] = (0.0,) * 6) -> Any:
    data = mujoco.MjData(model)
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "left_foot")
    data.xfrc_applied[body] = push
    for _ in range(int(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
    return data


def sole_contacts(model: Any, data: Any) -> Any:
    return foot_contacts(model, data, {mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "left_sole_box")})


def gathered(contacts: ContactSet) -> FootContacts:
    """The same for the kernel."""
    foot = FootContacts(np.zeros(1, dtype=np.uint8))
    ids = np.column_stack([contacts.own_geoms, contacts.other_geoms]).astype(np.int32).reshape(-1, 2)
    vectors = np.hstack([contacts.positions, contacts.forces, contacts.torques]).reshape(-1, 3)
    foot.take(ids, vectors, contacts.distances, contacts.carries.astype(np.uint8))
    return foot


@pytest.mark.parametrize("floor", [PLANE, BLOCK])
@pytest.mark.parametrize("first", [False, True])
def test_standing_foot_carries_its_weight_upwards(floor, first):
    """Third law: whichever geom comes first, the world pushes the foot up by m g."""
    model = foot_model(floor, first=first)
    data = settled(model)
    contacts = sole_contacts(model, data)
    sole = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "left_sole_box")
    assert (contacts.own_geoms == sole).all()
    assert (contacts.other_geoms == 1 - sole).all()
    assert contacts.forces.sum(axis=0) == pytest.approx([0.0, 0.0, MASS * GRAVITY], abs=1e-3)
    floor_side = foot_contacts(model, data, [1 - sole])
    assert floor_side.forces == pytest.approx(-contacts.forces)


@pytest.mark.parametrize("first", [False, True])
@pytest.mark.parametrize("condim", [3, 4, 6])
def test_wrench_balances_an_applied_push(first, condim):
    """Statics: contact wrench + weight + push = 0 about the sole origin, in sole and in world axes."""
    push = (12.0, -20.0, -60.0, 3.0, -6.0, 1.5)
    model = foot_model(BLOCK, first=first, com="0.01 -0.02 0.2", condim=condim)
    data = settled(model, push=push)
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, "left_sole")
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "left_foot")
    origin, rotation = data.site_xpos[site], data.site_xmat[site].reshape(3, 3)
    load = np.array(push)
    load[2] -= MASS * GRAVITY
    load[3:] += np.cross(data.xipos[body] - origin, load[:3])
    contacts = sole_contacts(model, data)
    world = contact_wrench_in_world(contacts, origin)
    assert world == pytest.approx(-load, abs=0.05)
    sole = contact_wrench_in_frame(contacts, origin, data.site_xmat[site])
    assert rotation @ sole[:3] == pytest.approx(world[:3], rel=1e-9, abs=1e-9)
    assert rotation @ sole[3:] == pytest.approx(world[3:], rel=1e-9, abs=1e-9)


def test_wrench_agrees_with_constraint_forces_of_mujoco():
    """The generalised constraint force on the free joint is the same wrench, computed by another path."""
    model = foot_model(BLOCK, condim=6)
    data = settled(model, seconds=0.02, push=(30.0, 10.0, -50.0, 2.0, 5.0, 3.0))
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "left_foot")
    world = contact_wrench_in_world(sole_contacts(model, data), data.xpos[body])
    rotation = data.xmat[body].reshape(3, 3)
    assert world[:3] == pytest.approx(data.qfrc_constraint[:3], abs=1e-9)
    assert rotation.T @ world[3:] == pytest.approx(data.qfrc_constraint[3:6], abs=1e-9)
    assert np.abs(world).min() > 1e-3


def test_foot_in_the_air_has_no_contact_and_no_zmp():
    model = foot_model(PLANE)
    data = mujoco.MjData(model)
    data.qpos[2] = 1.0
    mujoco.mj_forward(model, data)
    contacts = sole_contacts(model, data)
    assert contacts.size == 0
    truth = ground_truth([gathered(contacts)] * 2)
    assert truth.zmp is None
    assert truth.margin is None
    assert truth.polygon.shape == (0, 2)
    assert not truth.wrench.any()


def test_contacts_between_geoms_of_the_same_foot_are_left_out():
    model = foot_model(PLANE, first=True)
    data = settled(model, seconds=0.1)
    assert foot_contacts(model, data, range(model.ngeom)).size == 0
    assert foot_contacts(model, data, ()).size == 0


def test_truth_of_a_standing_foot():
    """Polygon is the sole, the ZMP is under the weight, the margin is its distance to the nearest edge."""
    model = foot_model(PLANE, com="0.03 -0.05 0.2")
    data = settled(model)
    truth = ground_truth([gathered(sole_contacts(model, data))])
    assert area(truth.polygon) == pytest.approx(0.25 * 0.155, rel=1e-3)
    assert truth.zmp == pytest.approx([0.03, -0.05], abs=2e-4)
    assert truth.margin == pytest.approx(0.0775 - 0.05, abs=2e-4)
    assert truth.wrench[2] == pytest.approx(MASS * GRAVITY, abs=1e-2)


def test_zmp_moves_with_the_height_of_its_plane():
    """A horizontal force f at height z shifts the ZMP of plane h by f (z - h) / fz: the line of action tilts."""
    model = foot_model(PLANE)
    data = settled(model, push=(40.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    feet = [gathered(sole_contacts(model, data))]
    low, high = (ground_truth(feet, plane_height=height).zmp for height in (0.0, 0.1))
    assert high[0] - low[0] == pytest.approx(-0.1 * 40.0 / (MASS * GRAVITY), rel=1e-3)
    assert ground_truth(feet, minimum_force=1e4).zmp is None


def test_contact_within_the_gap_carries_nothing_and_does_not_support():
    model = foot_model("<geom name='floor' type='plane' size='2 2 0.1' gap='0.01'/>")
    data = mujoco.MjData(model)
    data.qpos[2] = 0.015  # 5 mm above the floor: seen, not touched
    mujoco.mj_forward(model, data)
    contacts = sole_contacts(model, data)
    assert contacts.size == 4
    assert not contacts.carries.any()
    assert contacts.distances == pytest.approx(0.005)
    assert not contacts.forces.any()
    assert len(support_polygon_of_contacts([contacts])) == 0


def test_truth_of_two_feet_is_the_sum_of_its_parts():
    """One pass over both feet gives what wrench, ZMP and polygon give on their own."""
    model = foot_model(BLOCK, com="0.02 0.01 0.2")
    left = sole_contacts(model, settled(model, push=(20.0, -10.0, -30.0, 2.0, 3.0, 1.0)))
    right = left._replace(positions=left.positions + np.array([0.05, -0.3, 0.02]))
    feet = [left, right]
    truth = ground_truth([gathered(contacts) for contacts in feet])
    parts = [contact_wrench_in_world(c, np.zeros(3)) for c in feet]
    assert truth.wrench == pytest.approx(parts[0] + parts[1], abs=1e-9)
    fx, fy, fz, tx, ty, _ = parts[0] + parts[1]
    height = sum(c.positions[:, 2] @ c.forces[:, 2] for c in feet) / fz
    assert truth.zmp == pytest.approx([(height * fx - ty) / fz, (height * fy + tx) / fz], abs=1e-12)
    assert truth.polygon == pytest.approx(support_polygon_of_contacts(feet), abs=1e-12)
    assert truth.margin == pytest.approx(signed_margin(truth.polygon, truth.zmp), abs=1e-12)


def test_corner_lifted_by_micrometres_still_supports():
    """Under a load near a corner the opposite corner of a rigid box lifts; with a gap it stays in the polygon."""
    com = "0.09 0.055 0.05"
    bare = foot_model("<geom name='floor' type='plane' size='2 2 0.1'/>", com=com)
    seen = foot_model("<geom name='floor' type='plane' size='2 2 0.1' gap='0.001'/>", com=com)
    triangle = support_polygon_of_contacts([sole_contacts(bare, settled(bare))])
    contacts = sole_contacts(seen, settled(seen))
    assert len(triangle) == 3
    assert contacts.carries.sum() == 3
    assert 0.0 < contacts.distances.max() < 5e-4
    assert area(support_polygon_of_contacts([contacts])) == pytest.approx(0.25 * 0.155, rel=1e-3)
    assert len(support_polygon_of_contacts([contacts], reach=0.0)) == 3


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
@pytest.mark.parametrize("condim", [1, 3, 4, 6])
@pytest.mark.parametrize("first", [False, True])
def test_contacts_of_two_feet_are_mujocos_of_each(cone, condim, first):
    model = foot_model(BLOCK, first=first, condim=condim)
    model.opt.cone = getattr(mujoco.mjtCone, f"mjCONE_{cone.upper()}")
    data = settled(model, 0.3, (20.0, 30.0, 0.0, 5.0, 8.0, 2.0))
    foot, ground = (frozenset({model.geom(name).id}) for name in ("left_sole_box", "floor"))
    force = np.empty(6)
    for own, contacts in zip((foot, ground), feet_contacts(model, data, (foot, ground)), strict=True):
        assert contacts.size == data.ncon > 0
        for i in range(data.ncon):
            c = data.contact[i]
            sign = 1.0 if int(c.geom2) in own else -1.0
            mujoco.mj_contactForce(model, data, i, force)
            axes = c.frame.reshape(3, 3)
            assert contacts.forces[i] == pytest.approx(sign * force[:3] @ axes, abs=1e-9)
            assert contacts.torques[i] == pytest.approx(sign * force[3:] @ axes, abs=1e-9)
            assert contacts.positions[i].tolist() == c.pos.tolist()
            assert {int(contacts.own_geoms[i]), int(contacts.other_geoms[i])} == {int(c.geom1), int(c.geom2)}
            assert int(contacts.own_geoms[i]) in own
            assert contacts.distances[i] == c.dist
            assert contacts.carries[i] == (c.efc_address >= 0)
