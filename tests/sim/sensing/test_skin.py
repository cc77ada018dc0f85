"""Simulated skin: what the taxels feel of contacts of every kind, and the sensor around it."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from plantar import Percept, RobotError, hex_layout
from plantar.common.sides import SIDES
from plantar.gait.command import Command, Sensors
from plantar.sensing.force import center_of_pressure
from plantar.sim.model.contact_truth import ContactReader, FootContacts, contact_wrench_in_frame, foot_contacts
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene
from plantar.sim.sensing.proximity import ProximitySensor, SoleProximity
from plantar.sim.sensing.settings import Sensing
from plantar.sim.sensing.skin import SkinSensor, SoleSkin
from plantar.sim.terrain import GROUND_GROUP

from ..rates import drawn_seeds

GRAVITY = 9.81
MASS = 43.0
HALF = np.array([0.125, 0.0775])
OUTLINE = HALF * [[-1, -1], [1, -1], [1, 1], [-1, 1]]
LAYOUT = hex_layout(OUTLINE)
PLANE = "<geom name='floor' type='plane' size='2 2 0.1'/>"


def rig(ground: str, *, height: float = 0.01, com: str = "0 0 0.1", quat: str = "1 0 0 0") -> tuple[Any, Any, SoleSkin]:
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><option timestep="0.001" cone="elliptic"/><worldbody>{ground}
        <body name="left_foot" pos="0 0 {height}" quat="{quat}"><freejoint/>
        <inertial pos="{com}" mass="{MASS}" diaginertia="2 2 1"/>
        <geom name="left_sole_box" type="box" size="0.125 0.0775 0.01"/><site name="left_sole" pos="0 0 -0.01"/></body>
        </worldbody></mujoco>"""
    )
    return model, mujoco.MjData(model), SoleSkin(model, LAYOUT, "left_sole", ["left_sole_box"])


def run(model: Any, data: Any, seconds: float) -> None:
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)


def true_wrench(data: Any, skin: SoleSkin) -> NDArray[np.float64]:
    site = skin.site_id
    return contact_wrench_in_frame(
        foot_contacts(skin.model, data, skin.geom_ids), data.site_xpos[site], data.site_xmat[site]
    )


def test_a_pad_that_is_not_relieved_hides_a_part_of_the_load():
    model, data, skin = rig(PLANE)
    run(model, data, 0.5)
    bad = SoleSkin(model, LAYOUT, "left_sole", ["left_sole_box"], rim_stiffness=2.0)
    taxels = LAYOUT.areas.sum()
    share = taxels / (taxels + 2.0 * (4.0 * HALF.prod() - taxels))
    np.testing.assert_allclose(bad.taxel_forces(data), share * skin.taxel_forces(data), rtol=1e-3)
    assert 0.3 < share < 0.95


@pytest.mark.parametrize("com", ["0 0 0.1", "0.05 0.02 0.1", "-0.08 -0.05 0.1"])
@pytest.mark.parametrize("yaw", ["1 0 0 0", "0.924 0 0 0.383"])
def test_standing_foot_has_the_true_force_and_centre_of_pressure(com, yaw):
    model, data, skin = rig(PLANE, com=com, quat=yaw)
    run(model, data, 0.5)
    force = skin.taxel_forces(data)
    wrench = true_wrench(data, skin)
    assert force.sum() == pytest.approx(wrench[2], rel=1e-12)
    assert force.sum() == pytest.approx(MASS * GRAVITY, abs=1e-2)
    cop = center_of_pressure(LAYOUT, force, 0.0)
    assert cop == pytest.approx([-wrench[4] / wrench[2], wrench[3] / wrench[2]], abs=1e-6)
    assert cop == pytest.approx([float(v) for v in com.split()[:2]], abs=1e-3)


def test_foot_in_the_air_reads_zeros():
    model, data, skin = rig(PLANE, height=0.5)
    mujoco.mj_forward(model, data)
    assert skin.taxel_forces(data).tolist() == [0.0] * len(LAYOUT)


@pytest.mark.parametrize(("half_width", "offset"), [(0.06, 0.0), (0.03, 0.02), (0.02, -0.015)])
def test_beam_loads_the_cells_above_it_and_no_other(half_width, offset):
    beam = f"<geom name='beam' type='box' size='{half_width} 1 0.05' pos='{offset} 0 -0.05'/>"
    model, data, skin = rig(beam, com=f"{offset} 0 0.02")
    run(model, data, 0.3)
    force = skin.taxel_forces(data)
    assert force.sum() == pytest.approx(MASS * GRAVITY, rel=1e-3)
    for i, f in enumerate(force):
        x = LAYOUT.cell_polygon(i)[:, 0]
        over = x.max() > offset - half_width and x.min() < offset + half_width
        if not over:
            assert f == 0.0
        elif x.min() > offset - half_width and x.max() < offset + half_width:
            assert f > 1.0


def test_edge_contact_loads_a_strip_along_the_edge():
    """A foot pitched by 10 degrees touches along its toe edge."""
    model, data, skin = rig(PLANE, quat="0.9961947 0 0.0871557 0", height=0.0315)
    mujoco.mj_forward(model, data)
    contacts = foot_contacts(skin.model, data, skin.geom_ids)
    assert contacts.size == 2
    force = skin.taxel_forces(data)
    assert force.sum() == pytest.approx(true_wrench(data, skin)[2], rel=1e-9)
    assert force.sum() > 1.0
    assert LAYOUT.positions[force > 0, 0].min() > 0.09
    assert np.ptp(LAYOUT.positions[force > 0, 1]) > 0.1


def test_sphere_under_the_sole_loads_the_cells_around_its_point():
    x, y = 0.041, -0.022
    model, data, skin = rig(
        f"<geom name='pebble' type='sphere' size='0.02' pos='{x} {y} -0.0199'/>", com=f"{x} {y} 0.0"
    )
    mujoco.mj_forward(model, data)
    assert foot_contacts(skin.model, data, skin.geom_ids).size == 1
    force = skin.taxel_forces(data)
    assert force.sum() == pytest.approx(true_wrench(data, skin)[2], rel=1e-9)
    near = np.hypot(*(LAYOUT.positions[force > 0, :2] - [x, y]).T)
    assert 1 <= len(near) <= 3
    assert near.max() < 0.025


def test_two_blocks_carry_separate_patches():
    blocks = "".join(
        f"<geom name='block{i}' type='box' size='0.03 0.2 0.05' pos='{x} 0 -0.05'/>" for i, x in ((0, -0.09), (1, 0.09))
    )
    model, data, skin = rig(blocks, com="0.045 0 0.02")
    run(model, data, 0.3)
    force = skin.taxel_forces(data)
    x = LAYOUT.positions[:, 0]
    assert force[np.abs(x) < 0.04].max() == 0.0
    assert force.sum() == pytest.approx(MASS * GRAVITY, rel=1e-3)
    # Eight equal springs at x = -120, -60, 60, 120 mm: those on the right carry 1/2 + 45 (60 + 120) 4 / 2 / (8 * 9000).
    assert force[x > 0].sum() / force.sum() == pytest.approx(0.725, abs=1e-3)


def test_unknown_names_are_refused():
    model, _, _ = rig(PLANE)
    with pytest.raises(RobotError, match="no site named 'sole'; did you mean left_sole"):
        SoleSkin(model, LAYOUT, "sole", ["left_sole_box"])
    with pytest.raises(RobotError, match="no geom named 'box'; it has: floor, left_sole_box"):
        SoleSkin(model, LAYOUT, "left_sole", ["box"])
    with pytest.raises(RobotError, match="no collision geom"):
        SoleSkin(model, LAYOUT, "left_sole", [])


class _CountingSkin:
    """A skin whose every taxel reads the time in ms, and that counts how often it is asked."""

    def __init__(self) -> None:
        self.layout = LAYOUT
        self.calls = 0

    def __len__(self) -> int:
        return len(self.layout)

    def taxel_forces(self, data: Any, contacts: Any = None) -> NDArray[np.float64]:
        self.calls += 1
        return np.full(len(self.layout), 1e3 * data.time)


def sensor(seed: int = 0, dead: Sequence[int] = (), **options: float) -> tuple[SkinSensor, _CountingSkin]:
    skin = _CountingSkin()
    return SkinSensor(skin, Sensing(**{"force_noise": 0.0, **options}), np.random.default_rng(seed), dead=dead), skin


def at(time: float) -> Any:
    return SimpleNamespace(time=time)


def test_sensor_samples_at_its_rate_and_holds():
    device, skin = sensor(skin_rate=250.0)
    times = [device.read(at(i * 1e-3)).time for i in range(1000)]
    assert skin.calls == 250
    assert times[:9] == pytest.approx([0.0] * 4 + [0.004] * 4 + [0.008])
    assert device.read(at(5.0)).force[0] == pytest.approx(785.0)  # clipped at the layout's range


def test_sensor_of_an_odd_rate_keeps_its_mean_rate():
    device, skin = sensor(skin_rate=300.0)
    for i in range(3000):
        device.read(at(i * 1e-3))
    assert skin.calls == 900


def test_sensor_faster_than_the_physics_samples_every_step():
    device, skin = sensor(skin_rate=1000.0)
    assert [device.read(at(i * 4e-3)).time for i in range(50)] == pytest.approx([i * 4e-3 for i in range(50)])
    assert skin.calls == 50


def test_delay_is_whole_periods():
    device, _ = sensor(skin_rate=250.0, delay_periods=2)
    age = [i * 1e-3 - device.read(at(i * 1e-3)).time for i in range(100)]
    assert min(age[8:]) == pytest.approx(0.008)
    assert max(age[8:]) == pytest.approx(0.011)
    assert device.read(at(0.1)).force[3] == pytest.approx(92.0)


def test_noise_is_white_reproducible_and_clipped():
    def record(seed: int) -> NDArray[np.float64]:
        device, _ = sensor(seed, force_noise=1.47)
        return np.array([device.read(at(0.3 + i * 0.004)).force for i in range(400)])

    first = record(7)
    assert (first == record(7)).all()
    assert (first != record(8)).any()
    truth = 1e3 * (0.3 + 0.004 * np.arange(400))
    error = (first - truth[:, None])[:50]  # far from both ends of the range
    assert error.std() == pytest.approx(1.47, rel=0.05)
    assert first.max() == 785.0
    device, _ = sensor(force_noise=1.47)
    idle = device.read(at(0.0)).force
    assert idle.min() == 0.0
    assert 0.2 < np.mean(idle > 0.0) < 0.8


def test_dead_taxels_read_nan_and_leave_the_others_alone():
    whole, _ = sensor(3, force_noise=1.0)
    broken, _ = sensor(3, [2, 5], force_noise=1.0)
    a, b = whole.read(at(0.1)).force, broken.read(at(0.1)).force
    assert np.isnan(b).nonzero()[0].tolist() == [2, 5]
    alive = ~np.isnan(b)
    assert (a[alive] == b[alive]).all()


@pytest.mark.parametrize(("gap", "whole"), [(1e-4, True), (1e-3, False)])
def test_corner_lifted_by_micrometres_stays_in_the_patch(gap, whole):
    """Three corners carry, the fourth hovers: near enough, the patch is the whole sole, else half of it."""
    model, data, skin = rig(PLANE)
    mujoco.mj_forward(model, data)
    contacts = FootContacts(np.zeros(1, dtype=np.uint8))
    vectors = np.zeros((4, 3, 3))  # place, force and torque of each
    vectors[:, 0, :2], vectors[1:, 1, 2] = OUTLINE, 100.0
    gaps, carries = np.array([gap, 0.0, 0.0, 0.0]), np.array([0, 1, 1, 1], dtype=np.uint8)
    contacts.take(np.tile(np.array([1, 0], dtype=np.int32), (4, 1)), vectors.reshape(-1, 3), gaps, carries)
    force = skin.taxel_forces(data, contacts)
    assert force.sum() == pytest.approx(300.0)
    beyond = LAYOUT.positions[:, :2] @ (1.0 / HALF) < -0.3  # on the hovering corner's side of the diagonal
    assert (force[beyond].max() > 1.0) == whole


@pytest.mark.parametrize("level", ["0", "2"])
def test_a_walking_foot_in_the_air_touches_nothing(level):
    """Fewer than one false contact in 10,000 samples: of a thousand, more than two come once in ten thousand walks."""
    (seed,) = drawn_seeds(test_a_walking_foot_in_the_air_touches_nothing, 1, level)
    simulation = Simulation(load_scene("flat", ["steps=3", "settle=0.3", "plant=random", f"level={level}"]), seed)
    loaded = dict.fromkeys(SIDES, 0.0)
    found: list[bool] = []
    step = simulation.controller.step

    def watched(sensors: Sensors) -> Command:
        for side, load in zip(SIDES, simulation.judge.loads, strict=True):
            if load > 0.0:
                loaded[side] = sensors.time
            elif sensors.time > loaded[side] + 0.03:  # longer than readings are late
                percept = Percept(simulation.robot.layouts[side], sensors.readings[side])
                found.append(bool(percept.active.any()))
                assert found[-1] == (len(percept.support_polygon_in_sole) > 0)
        return step(sensors)

    simulation.controller.step = watched  # type: ignore[method-assign]
    simulation.run()
    assert len(found) > 300
    assert sum(found) <= 2


@pytest.mark.parametrize("delay", [0, 2])
def test_a_sole_that_is_sampled_in_one_kernel_reads_the_same(delay):
    model, data, skin = rig(f"{PLANE}<geom type='box' pos='0.1 0 0' size='0.05 0.2 0.004'/>")
    model.geom_group[:2] = GROUND_GROUP
    feet = ContactReader(model, data, (skin.geom_ids,))
    sensors = []
    for _ in range(2):
        rays = SoleProximity(model, LAYOUT, "left_sole")
        near = ProximitySensor(rays, 2e-3, 1e-3, np.random.default_rng(4), dead=[2])
        sole = SoleSkin(model, LAYOUT, "left_sole", ["left_sole_box"])
        sensing = Sensing(delay_periods=delay)
        sensors.append(SkinSensor(sole, sensing, np.random.default_rng(5), near, dead=[7]))
    kernel, parts = sensors
    other = mujoco.MjData(model)
    mujoco.mj_forward(model, other)
    readings = set()
    for k in range(400):
        mujoco.mj_step(model, data)
        wanted = k % 7 > 2
        if k == 150:
            kernel.skin.taxel_forces(other)  # another look at it, between two readings
        one = kernel.read(data, feet.read()[0], near=wanted)
        two = parts.read(data, near=wanted)
        readings.add(one.time)
        assert one.time == two.time
        assert np.array_equal(one.force, two.force, equal_nan=True)
        assert (one.proximity is None) == (two.proximity is None)
        if one.proximity is not None:
            assert np.array_equal(one.proximity, two.proximity, equal_nan=True)
    assert len(readings) > 90
    assert (kernel.proximity.cast, kernel.proximity.skipped) == (parts.proximity.cast, parts.proximity.skipped)
    assert kernel.proximity.skipped > 0
