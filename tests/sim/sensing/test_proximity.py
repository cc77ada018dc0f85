"""Rays of the taxels against ground of every shape, and the sensor around them."""

from typing import Any

import mujoco
import numpy as np
import pytest

from plantar import RobotError, fit_ground_plane, hex_layout
from plantar.mechanics.rotation import rotation_from_angles
from plantar.sim.sensing.proximity import ProximitySensor, SoleProximity
from plantar.sim.terrain import GROUND_GROUP, Solid

LAYOUT = hex_layout([[-0.125, -0.0775], [0.125, -0.0775], [0.125, 0.0775], [-0.125, 0.0775]])


def rig(ground: str, *, height: float = 0.03, quat: str = "1 0 0 0", top: float = np.inf) -> tuple[Any, SoleProximity]:
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody>{ground.replace("<geom", f"<geom group='{GROUND_GROUP}'")}
        <geom name="own" type="box" size="1 1 .001" pos="0 0 {0.5 * height}"/>
        <body name="foot" pos="0 0 {height}" quat="{quat}"><freejoint/>
        <geom type="box" size="0.125 0.0775 0.01" pos="0 0 .01" mass="1"/><site name="left_sole"/></body>
        </worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return data, SoleProximity(model, LAYOUT, "left_sole", ground_top=top)


PLANE = "<geom type='plane' size='2 2 .1'/>"


def test_level_ground_is_as_far_as_the_sole_is_high_and_the_robot_is_not_seen():
    data, sole = rig(PLANE)
    assert sole.distances(data) == pytest.approx(np.full(len(LAYOUT), 0.03), abs=1e-12)


def test_a_sloping_sole_measures_along_its_own_axis():
    angle = 0.15
    data, sole = rig(PLANE, quat=f"{np.cos(angle / 2)} 0 {np.sin(angle / 2)} 0")
    plane = fit_ground_plane(LAYOUT, sole.distances(data))
    assert np.arctan(plane.slope[0]) == pytest.approx(angle, abs=1e-9)
    assert plane.slope[1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("ground", "point", "distance"),
    [
        ("<geom type='box' size='.02 .02 .01' pos='0 0 .005'/>", (0.0, 0.0), 0.015),
        ("<geom type='sphere' size='.015' pos='0.03 0 0'/>", (0.03, 0.0), 0.015),
        ("<geom type='cylinder' size='.03 .012' pos='0 .02 0'/>", (0.0, 0.02), 0.018),
    ],
)
def test_what_lies_under_some_taxels_is_seen_by_those(ground, point, distance):
    data, sole = rig(PLANE.replace("/>", " pos='0 0 -1'/>") + ground)
    seen = sole.distances(data)
    near = np.hypot(*(LAYOUT.positions[:, :2] - point).T)
    assert 1 <= np.isfinite(seen).sum() <= 8
    assert seen[np.argmin(near)] == pytest.approx(distance, abs=0.006)
    assert seen.min() >= distance - 1e-9
    assert np.isinf(seen[near > 0.04]).all()


def test_beyond_the_range_nothing_is_seen_and_a_pressed_taxel_is_negative():
    data, sole = rig(PLANE, height=0.0501)
    assert np.isinf(sole.distances(data)).all()
    data, sole = rig(PLANE, height=-0.002)
    assert sole.distances(data) == pytest.approx(np.full(len(LAYOUT), -0.002), abs=1e-12)


def test_no_ray_is_cast_high_above_the_highest_ground():
    data, sole = rig(PLANE, height=0.2, top=0.14)
    assert not sole.within_range(data)
    before = sole.look(data).lengths.copy()
    assert np.isinf(sole.distances(data)).all()
    assert sole.look(data).lengths.tolist() == before.tolist() == [0.0] * len(LAYOUT)  # nothing was cast
    data, sole = rig(PLANE, height=0.2, top=0.16)
    assert sole.within_range(data)
    # A sole on its edge reaches far below its frame.
    data, sole = rig(PLANE, height=0.2, quat="0.7071 0 0.7071 0", top=0.05)
    assert sole.within_range(data)


def test_noise_bias_and_dead_taxels():
    data, sole = rig(PLANE)
    device = ProximitySensor(sole, 2e-3, 5e-3, np.random.default_rng(1), dead=[3, 7])
    rows = np.array([device.read(data, True) for _ in range(200)])
    assert np.isnan(rows[:, [3, 7]]).all()
    alive = np.delete(rows, [3, 7], axis=1)
    assert alive.mean() == pytest.approx(0.035, abs=1e-4)
    assert alive.std() == pytest.approx(2e-3, rel=0.05)
    assert (device.cast, device.skipped) == (200 * len(LAYOUT), 0)


def test_a_sole_that_is_not_asked_for_is_free_and_leaves_the_noise_in_step():
    data, sole = rig(PLANE)
    asked, plain = (ProximitySensor(sole, 2e-3, 0.0, np.random.default_rng(1)) for _ in range(2))
    everything = ProximitySensor(sole, 2e-3, 0.0, np.random.default_rng(1))
    for k in range(10):
        all_of_it = asked.read(data, True)
        some = plain.read(data, k >= 5)
        every = everything.read(data, k >= 5, True)
        assert (some is None) == (every is None) == (k < 5)
        if some is not None and every is not None and all_of_it is not None:
            assert (some == all_of_it).all()
            assert (every == all_of_it).all()
    assert (plain.cast, plain.skipped) == (5 * len(LAYOUT), 5 * len(LAYOUT))
    assert (everything.cast, everything.skipped) == (10 * len(LAYOUT), 0)


@pytest.mark.parametrize("shape", ["box", "sphere", "ellipsoid", "cylinder"])
def test_the_top_of_a_solid_is_where_rays_from_above_begin_to_meet_it(shape):
    solid = Solid(shape, (0.05, 0.03, 0.02), np.array([0.0, 0.0, 0.1]), rotation_from_angles(0.3, 0.4, -0.2))
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, solid.rotation.ravel())
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco><worldbody><geom type='{shape}' size='.05 .03 .02' pos='0 0 .1'"
        f" quat='{' '.join(map(str, quaternion))}'/></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    grid = np.linspace(-0.07, 0.07, 141)
    geom = np.empty(1, dtype=np.int32)
    hits = [
        1.0 - length
        for x in grid
        for y in grid
        if (length := mujoco.mj_ray(model, data, np.array([x, y, 1.0]), np.array([0.0, 0, -1]), None, 1, -1, geom)) > 0
    ]
    assert solid.top == pytest.approx(max(hits), abs=1e-3)
    assert solid.top >= max(hits) - 1e-12


def test_unknown_sites_are_refused():
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><site name='a'/></worldbody></mujoco>")
    with pytest.raises(RobotError, match="no site named 'left_sole'"):
        SoleProximity(model, LAYOUT, "left_sole")
