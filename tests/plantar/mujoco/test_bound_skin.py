"""Skin on models of many kinds: its taxels' forces against MuJoCo's own contact forces."""

import pickle
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import mujoco
import numpy as np
import pytest
import shapely

from plantar import Percept, grid_layout, layout_of_cells
from plantar.errors import InputError
from plantar.kernels.contacts.foot_contacts import ContactsInSole, FootContacts
from plantar.kernels.contacts.taxel_load import TaxelLoad
from plantar.mujoco import Skin
from plantar.sensing.taxel_faults import TaxelFaults

spec = spec_from_file_location("skin_models", Path(__file__).parent / "conftest.py")
models = module_from_spec(spec)
spec.loader.exec_module(models)
KINDS = models.KINDS
ROBOTS = {
    "booster_t1/t1.xml": "left_foot_link",
    "robotis_op3/op3.xml": "l_ank_roll_link",
    "unitree_h1/h1.xml": "left_ankle_link",
    "jvrc1/xml/jvrc1.xml": "L_ANKLE_P_S",
}


def compare(model, contact_wrench, steps, **options):
    """Simulate and compare; how many readings carried all."""
    feel = Skin(body=options.pop("body", "foot"), **options).bind(model)
    data, carried, pressed = mujoco.MjData(model), 0, 0
    for _ in range(steps):
        mujoco.mj_step(model, data)
        reading, wrench = feel(data), contact_wrench(feel, data)
        load = max(np.linalg.norm(wrench[:3]), 1e-9)
        assert np.abs(reading.wrench - wrench).max() <= 1e-9 * load
        if not wrench[2] > 0.0:
            assert not reading.force.any()
            assert reading.position_cop_in_sole is None
            continue
        pressed += 1
        carried += reading.carried
        total, moment = reading.vectors.sum(axis=0), np.cross(feel.layout.positions, reading.vectors).sum(axis=0)
        assert np.abs(total - wrench[:3]).max() <= 1e-9 * load
        assert (reading.force >= 0.0).all()
        if reading.carried:
            assert np.abs(moment - wrench[3:]).max() <= 1e-9 * load
        else:  # only where the centre of pressure is beyond the outermost taxels
            cop = np.array([-wrench[4], wrench[3]]) / wrench[2]
            ring, normal = feel.static[-1], reading.vectors[:, 2]
            own = normal @ feel.layout.positions[:, :2] / normal.sum()
            away = shapely.Polygon(ring).distance(shapely.Point(cop))
            assert np.hypot(*(own - cop)) <= away + 0.02 * np.ptp(ring)  # the load is on the nearest edge
            edge = np.roll(ring, -1, axis=0) - ring
            inside = (edge[:, 0] * (cop - ring)[:, 1] - edge[:, 1] * (cop - ring)[:, 0]) / np.hypot(*edge.T)
            assert inside.min() < 1e-3
    assert pressed > steps // 2
    return carried / pressed


@pytest.mark.parametrize("kind", KINDS)
def test_taxels_add_up_to_the_contact_wrench(kind, contact_wrench):
    assert compare(mujoco.MjModel.from_xml_string(KINDS[kind]), contact_wrench, 400) > 0.5


@pytest.mark.parametrize("file", ROBOTS)
def test_public_robots_stand_on_their_skins(file, contact_wrench):
    path = models.ROBOTS / file
    if not path.exists():
        pytest.skip("the robots' files are not here")
    spec = mujoco.MjSpec.from_file(str(path))
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5.0, 5.0, 1.0])
    model = spec.compile()
    if model.nkey == 0:  # put it on the ground
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, ROBOTS[file])
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        geoms = Skin(body=ROBOTS[file]).bind(model)
        model.qpos0[2] -= geoms.pose(data).position_in_world[2] - 1e-3
        assert body > 0
    compare(model, contact_wrench, 100, body=ROBOTS[file])


def test_lit_cells_are_those_of_the_contact_to_one_row(make_box):
    slab = '<geom type="box" size=".06 .3 .05" pos=".01 0 -.05"/>'
    model = mujoco.MjModel.from_xml_string(models.world(slab, models.BOX.format(condim=3)))
    feel = Skin(body="foot", cell_area=2e-4).bind(model)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 20)
    lit, x = feel(data).force > 0.0, feel.layout.positions[:, 0]
    row = 0.017
    assert lit[(x > -0.05 + row) & (x < 0.07 - row)].all()
    assert not lit[(x < -0.05 - row) | (x > 0.07 + row)].any()


def test_depth_is_the_overlap_of_the_geoms(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 300)
    reading = feel(data)
    assert 0.0 < reading.depth.max() <= -data.contact.dist.min() + 1e-12
    assert reading.depth.argmax() in np.flatnonzero(feel.layout.positions[:, 0] > 0.0)  # where the load is


def test_a_load_on_the_back_does_not_relieve_the_sole(contact_wrench):
    model = mujoco.MjModel.from_xml_string(models.STACK)
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 1500)
    reading = feel(data)
    assert np.allclose(reading.wrench, contact_wrench(feel, data), atol=1e-9)
    assert reading.wrench[2] == pytest.approx(5.0 * 9.81, rel=1e-3)  # of all contacts: its own weight
    assert reading.force.sum() == pytest.approx(10.0 * 9.81, rel=1e-3)  # below it: the other box's too
    moment = np.cross(feel.layout.positions, reading.vectors).sum(axis=0)[:2]
    assert moment == pytest.approx([5.0 * 9.81 * 0.03, -5.0 * 9.81 * 0.05], rel=0.01)
    assert not reading.carried


@pytest.mark.parametrize("middles", [[(-0.08, 0), (0.08, 0)], [(-0.08, -0.04), (0, 0), (0.04, 0.02)]])
def test_a_row_of_taxels_carries_a_load_on_its_line(middles):
    corners = [[-0.005, -0.005], [0.005, -0.005], [0.005, 0.005], [-0.005, 0.005]]
    layout = layout_of_cells([np.add(middle, corners) for middle in middles])
    model = mujoco.MjModel.from_xml_string(models.world(models.PLANE, '<geom type="box" size=".1 .05 .02"/>'))
    feel, data = Skin(layout, body="foot", partial=True).bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    reading = feel(data)
    moment = np.cross(feel.layout.positions, reading.vectors).sum(axis=0)
    assert reading.carried
    assert np.allclose([*reading.vectors.sum(axis=0), *moment], reading.wrench, atol=1e-9)


@pytest.mark.parametrize("condim", [1, 4])
@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_a_geom_that_sticks_presses_with_what_it_does_not_pull(condim, cone, contact_wrench):
    sticky = models.box(condim, f'cone="{cone}"').replace("condim=", 'adhesion="5" condim=')
    model = mujoco.MjModel.from_xml_string(sticky)
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 1000)
    assert np.allclose(feel(data).wrench, contact_wrench(feel, data), atol=1e-9)
    assert feel(data).vectors.sum(axis=0)[2] == pytest.approx(11.0 * 9.81, rel=1e-3)


def test_a_load_far_beyond_the_taxels_is_on_their_nearest_edge():
    """Place and force of three contacts on a ball with much shear, of which no patch has the moment."""
    ball = '<mujoco><worldbody><body name="foot"><freejoint/><geom size=".023"/></body></worldbody></mujoco>'
    feel = Skin(body="foot").bind(mujoco.MjModel.from_xml_string(ball))
    contacts = [
        [[0.0156, -0.0121, 0.0203], [-16.5, -17.4, 15.6], [0, 0, 0]],
        [[0.0027, 0.0198, 0.0177], [14.0, -13.8, 13.0], [0, 0, 0]],
        [[0.0088, -0.0037, 0.0285], [-16.4, -14.3, 6.5], [0, 0, 0]],
    ]
    load, seen, foot = TaxelLoad(*feel.static), ContactsInSole(), FootContacts(np.ones(1, dtype=np.uint8))
    pairs = np.array([[0, 1], [0, 2], [0, 3]], dtype=np.int32)
    foot.take(pairs, np.array(contacts, dtype=float).reshape(-1, 3), np.zeros(3), np.ones(3, dtype=np.uint8))
    seen.look_from(np.zeros(3), np.eye(3))
    load.press(foot, seen, 5e-4)
    assert not load.carried
    cop, normal, ring = (
        np.array([-load.wrench[4], load.wrench[3]]) / load.wrench[2],
        load.vectors[:, 2],
        feel.static[-1],
    )
    own = normal @ feel.layout.positions[:, :2] / normal.sum()
    away = shapely.Polygon(ring).distance(shapely.Point(cop))
    assert np.hypot(*(own - cop)) <= away + 0.02 * np.ptp(ring)


def test_another_cone_after_binding_is_read_as_such(make_box, contact_wrench):
    model = mujoco.MjModel.from_xml_string(make_box(euler="0 3 0", z=0.03))
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    for cone in (0, 1, 0):
        model.opt.cone = cone
        mujoco.mj_step(model, data, 40)
        assert np.allclose(feel(data).wrench, contact_wrench(feel, data), atol=1e-9)
        assert feel(data).wrench[2] > 10.0


def test_proximity_is_the_distance_to_the_ground(make_box):
    model = mujoco.MjModel.from_xml_string(make_box(z=0.05, euler="0 3 0"))
    feel, data = Skin(body="foot", proximity=0.05).bind(model), mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    height = feel.pose(data).to_world(feel.layout.positions)[:, 2] / np.cos(np.radians(3.0))
    assert np.allclose(feel(data).proximity, height, atol=1e-9)
    data.qpos[2] = 1.0
    mujoco.mj_forward(model, data)
    assert np.isinf(feel(data).proximity).all()
    assert not feel(data).force.any()


def test_proximity_does_not_see_the_foots_own_parts():
    """A foot of 1 cm whose sole and looks are bodies of their own, below a shank that reaches into it."""
    box = '<geom type="box" size="{}" {}/>'
    shank = box.format(".03 .03 .2", 'pos="0 0 .2"') + '<body name="ankle"><joint/>' + box.format(".02 .02 .005", "")
    sole, looks = box.format(".1 .05 .005", ""), box.format(".11 .06 .006", 'contype="0" conaffinity="0"')
    parts = f'{shank}<body name="sole">{sole}</body><body>{looks}</body></body>'
    model = mujoco.MjModel.from_xml_string(models.world(models.PLANE, parts, 0.055))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for body in ("ankle", "sole"):
        assert Skin(body=body, proximity=0.1).bind(model)(data).proximity == pytest.approx(0.05, abs=1e-9)


def test_many_and_rollout_are_what_single_readings_are(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, kind = Skin(body="foot").bind(model), mujoco.mjtState.mjSTATE_FULLPHYSICS
    datas, states = [mujoco.MjData(model) for _ in range(6)], []
    for i, data in enumerate(datas):
        data.qvel[0] = 0.1 * i
        mujoco.mj_step(model, data, 5)
        mujoco.mj_forward(model, data)
        states.append(np.empty(mujoco.mj_stateSize(model, kind)))
        mujoco.mj_getState(model, data, states[-1], kind)
    one = np.array([feel(d).vectors for d in datas])
    for threads in (1, 3):
        forces, wrenches = feel.many(datas, threads)
        assert np.array_equal(forces, one)
        assert np.array_equal(wrenches, [feel(d).wrench for d in datas])
        again, _ = feel.rollout(np.array(states).reshape(2, 3, -1), threads=threads)
        assert again.shape == (2, 3, len(feel), 3)
        assert np.allclose(again.reshape(one.shape), one, atol=1e-6)
    assert np.array_equal(feel.rollout(np.array(states), np.zeros((6, 0)))[0], again.reshape(one.shape))
    with pytest.raises(InputError, match="states: shape"):
        feel.rollout(np.zeros((2, 3)))
    with pytest.raises(InputError, match="states"):
        feel.rollout(np.where(np.arange(one.shape[0])[:, None] == 2, np.nan, np.array(states)))


def test_a_diverged_state_is_not_in_the_air(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 200)
    data.qvel[2] = np.nan
    mujoco.mj_forward(model, data)
    reading = feel(data)
    assert np.isnan(reading.force).all()
    assert np.isnan(feel.many([data])[0]).all()
    assert not reading.carried
    mujoco.mj_resetData(model, data)
    mujoco.mj_step(model, data, 200)
    assert feel(data).force.sum() == pytest.approx(11.0 * 9.81, rel=1e-2)


def test_threads_may_read_the_same_data(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, data = Skin(body="foot", cell_area=1e-4).bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 200)
    alone, interval = feel(data), sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        forces = np.array([feel.many([data] * 8, threads=4)[0] for _ in range(600)])
    finally:
        sys.setswitchinterval(interval)
    assert (forces == alone.vectors).all()


def test_a_reading_is_one_of_its_own(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 50)
    first = feel(data)
    kept = first.vectors.copy()
    mujoco.mj_step(model, data, 50)
    feel(data)
    assert np.array_equal(first.vectors, kept)
    again = pickle.loads(pickle.dumps(first))
    assert np.array_equal(again.vectors, kept)
    assert again.time == first.time
    assert np.allclose(Percept(feel.layout, first, 0.0).wrench_in_sole[[2, 3, 4]], first.wrench[[2, 3, 4]])
    assert feel.percept(data).vertical_force > 0.9 * feel(data).wrench[2]  # without taxels below the threshold


def test_data_of_another_model_are_refused(make_box):
    feel = Skin(body="foot").bind(mujoco.MjModel.from_xml_string(make_box()))
    other = mujoco.MjModel.from_xml_string(KINDS["two soles on a slab"])
    with pytest.raises(InputError, match="another model"):
        feel(mujoco.MjData(other))
    names = [f'<body name="{n}" pos="{len(n)} 0 0"><freejoint/><geom size=".1"/></body>' for n in ("foot", "a")]
    swapped = [
        mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{first}{then}</worldbody></mujoco>")
        for first, then in (names, names[::-1])
    ]
    with pytest.raises(InputError, match="another model"):  # as many bodies, in another order
        Skin(body="foot").bind(swapped[0])(mujoco.MjData(swapped[1]))
    for old, new in (('size=".12', 'size=".1'), ('<geom type="box"', '<geom type="box" pos="0 0 .01"')):
        with pytest.raises(InputError, match="another model"):  # a foot of another size, or elsewhere on its body
            feel(mujoco.MjData(mujoco.MjModel.from_xml_string(make_box().replace(old, new))))
    for read in (feel, feel.pose, feel.many, feel.rollout):
        with pytest.raises(InputError, match=r"got a str|not numeric"):
            read("data")


def test_old_data_are_not_kept(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, first = Skin(body="foot").bind(model), mujoco.MjData(model)
    feel(first)
    held = sys.getrefcount(first)
    for _ in range(100):
        feel(mujoco.MjData(model))
    assert sys.getrefcount(first) < held
    feel.many([mujoco.MjData(model) for _ in range(100)])
    assert len(feel._views) == 100


def test_a_bound_skin_and_data_can_be_sent_to_another_process(make_box):
    model = mujoco.MjModel.from_xml_string(make_box())
    feel, data = Skin(body="foot").bind(model), mujoco.MjData(model)
    mujoco.mj_step(model, data, 50)
    there, sent = pickle.loads(pickle.dumps((feel, data)))
    assert np.array_equal(there(sent).vectors, feel(data).vectors)


def test_forces_do_not_jump_as_the_foot_rolls():
    ground = '<geom type="sphere" size=".3" pos="0 0 -.3"/>'
    model = mujoco.MjModel.from_xml_string(models.world(ground, models.BOX.format(condim=3)))
    outline = [[-0.12, -0.05], [0.12, -0.05], [0.12, 0.05], [-0.12, 0.05]]
    feel = Skin(grid_layout(outline, pitch=(0.015, 0.015)), body="foot").bind(model)
    data = mujoco.MjData(model)

    def shares(x):
        data.qpos[:3] = x, 0.3 * x, 0.0195
        mujoco.mj_forward(model, data)
        force = feel(data).force
        return force / force.sum()

    for x in np.linspace(0.0, 0.03, 100):
        assert np.abs(shares(x + 1e-6) - shares(x)).max() < 1e-3


def point_velocity(model, data, body, point):
    """Velocity (3,) of a point of a body in the world, by MuJoCo's Jacobian."""
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, jacobian, None, point, body)
    return jacobian @ data.qvel


@pytest.mark.parametrize("way", [{}, {"outward": (0, 0, -1)}])
@pytest.mark.parametrize("kind", ["box", "moving ground", "spheres"])
def test_slip_is_the_velocity_along_what_a_taxel_touches(kind, way):
    model = mujoco.MjModel.from_xml_string(KINDS[kind])
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 200)
    foot = model.body("foot").id
    first = model.jnt_dofadr[model.body_jntadr[foot]]
    data.qvel[first : first + 6] += [0.3, -0.2, 0.0, 0.0, 0.0, 1.5]
    mujoco.mj_forward(model, data)
    feel = Skin(body="foot", slip=True, **way).bind(model)
    reading = feel(data)
    pose = feel.pose(data)
    ground = 1 if kind == "moving ground" else 0
    loaded = np.flatnonzero(reading.force > 0.0)
    assert len(loaded) > 3
    for i in loaded:
        at = pose.position_in_world + pose.rotation_sole_to_world @ feel.layout.positions[i]
        off = point_velocity(model, data, foot, at) - point_velocity(model, data, ground, at)
        axis = pose.rotation_sole_to_world @ feel.layout.rotations[i][:, 2]
        along = pose.rotation_sole_to_world.T @ (off - axis * (axis @ off))
        assert np.abs(reading.slip[i] - along).max() < 1e-9
    assert np.linalg.norm(reading.slip[loaded], axis=1).max() > 0.3
    assert not np.delete(reading.slip, loaded, axis=0)[reading.force[np.setdiff1d(range(len(feel)), loaded)] == 0].any()
    assert Skin(body="foot", **way).bind(model)(data).slip is None
    assert reading.proximity is None
    data.qpos[model.jnt_qposadr[model.body_jntadr[foot]] + 2] += 1.0
    mujoco.mj_forward(model, data)
    assert not feel(data).slip.any()


def test_faults_are_those_of_the_seed_and_leave_the_truth():
    model = mujoco.MjModel.from_xml_string(KINDS["box"])
    faults = TaxelFaults(0.1, 0.5, 0.3, 0.1, 0.15, 0.1, 0.2, 0.0, 0.02, 0.013, 0.01, 0.1, 30.0, 0.2, 0.1, 0.2)
    feel, plain = Skin(body="foot", faults=faults, seed=4).bind(model), Skin(body="foot").bind(model)
    worn = faults.worn(feel.layout, 4)
    data = mujoco.MjData(model)
    for run in range(2):
        mujoco.mj_resetData(model, data)
        worn.reset()
        for _ in range(30):
            mujoco.mj_step(model, data)
            truth, read = plain(data), feel(data)
            assert np.array_equal(read.vectors, truth.vectors)
            assert np.array_equal(read.wrench, truth.wrench)
            expected = worn.read(data.time, truth.force, truth.vectors)
            assert np.array_equal(read.force, expected, equal_nan=True), run
    assert np.isnan(read.force).any()
    data.efc_force[:] = np.nan
    assert np.isnan(feel(data).force).all()  # diverged
    assert pickle.loads(pickle.dumps(read)).force.tobytes() == read.force.tobytes()


def test_proximity_of_a_thin_plate_does_not_see_what_is_behind_it():
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody><body name="plate"><freejoint/>
      <geom type="box" size=".06 .06 .004"/></body>
      <body mocap="true" pos="0 0 -.027"><geom type="box" size=".05 .05 .02"/></body></worldbody></mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    front, behind = (Skin(body="plate", outward=(0, 0, z), proximity=0.05).bind(model)(data) for z in (1, -1))
    assert np.isinf(front.distance).all()
    assert behind.distance.min() == pytest.approx(0.003, abs=1e-9)
