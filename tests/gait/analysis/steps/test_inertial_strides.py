"""Strides by an inertial sensor: feet that are moved as stated, and the maker's own report of two walks."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.common.gravity import GRAVITY
from plantar.gait.analysis.analyse import analyse
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.inertial_strides import inertial_strides

RATE = 100.0
STANCE, SWING = 70, 50  # frames


def moved(lengths, heights=None, mounted=(0.2, -0.1, 1.0), offset=(0.03, -0.05, 0.04), noise=0.0):
    """Times, motion and contacts of a foot that rests, swings by each length, and turns as feet do.

    `mounted`: rotation vector of the sensor in the foot; `offset`: of the angular rate in rad/s.
    """
    heights = heights or [0.0] * len(lengths)
    fine = 10  # samples a frame
    share = np.arange(SWING * fine) / (SWING * fine)
    jerk = 10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5
    x, z, pitch, yaw = (np.zeros(STANCE * fine) for _ in range(4))
    for length, height in zip(lengths, heights, strict=True):
        x = np.concatenate([x, x[-1] + length * jerk, np.full(STANCE * fine, x[-1] + length)])
        lift = z[-1] + height * jerk + 0.6 * (share * (1.0 - share)) ** 3 * 10.0
        z = np.concatenate([z, lift, np.full(STANCE * fine, z[-1] + height)])
        turn = 0.7 * np.sin(2.0 * np.pi * share) * np.sin(np.pi * share) ** 2
        pitch = np.concatenate([pitch, turn, np.zeros(STANCE * fine)])
        yaw = np.concatenate([yaw, 0.4 * turn, np.zeros(STANCE * fine)])
    dt = 1.0 / (RATE * fine)
    place = np.stack([0.8 * x, 0.6 * x, z], axis=1)
    world = np.gradient(np.gradient(place, dt, axis=0), dt, axis=0)
    world[:, 2] += GRAVITY
    sensor = Rotation.from_euler("zy", np.stack([yaw, pitch], axis=1)) * Rotation.from_rotvec(mounted)
    rate = np.zeros((len(x), 3))
    rate[:-1] = (sensor[:-1].inv() * sensor[1:]).as_rotvec() / dt
    motion = np.hstack([sensor.inv().apply(world), rate + offset])[::fine]
    motion += noise * np.random.default_rng(1).normal(size=motion.shape)
    time = np.arange(len(motion)) / RATE
    begins = [k * (STANCE + SWING) for k in range(len(lengths) + 1)]
    contacts = [Contact(b / RATE, (b + STANCE - 1) / RATE, b, b + STANCE) for b in begins]
    return time, motion, contacts


@pytest.mark.parametrize("mounted", [(0.0, 0.0, 0.0), (0.2, -0.1, 1.0), (3.0, 0.3, 0.0)])
def test_lengths_are_those_that_the_foot_was_moved_by(mounted):
    lengths = [1.4, 1.1, 0.6, 1.5]
    found = inertial_strides(*moved(lengths, mounted=mounted, noise=0.02))
    assert found[:-1] == pytest.approx(lengths, rel=0.02)
    assert np.isnan(found[-1])


def test_a_slope_or_stair_leaves_the_level_length():
    assert inertial_strides(*moved([1.2] * 4, heights=[0.1] * 4))[:-1] == pytest.approx([1.2] * 4, rel=0.02)


def test_a_short_gap_is_bridged_and_a_long_one_leaves_the_stride_unknown():
    time, motion, contacts = moved([1.2] * 4)
    swing = STANCE + 20
    motion[swing : swing + 2] = np.nan
    motion[STANCE + SWING + swing : STANCE + SWING + swing + 12] = np.nan
    found = inertial_strides(time, motion, contacts)
    assert found[0] == pytest.approx(1.2, rel=0.02)
    assert np.isnan(found[1])
    assert found[2:4] == pytest.approx([1.2, 1.2], rel=0.02)


def test_what_cannot_be_integrated_is_unknown():
    time, motion, contacts = moved([1.2] * 4)
    assert np.isnan(inertial_strides(4.0 * time, motion, contacts)).all()  # 25 Hz
    assert np.isnan(inertial_strides(time, np.full_like(motion, np.nan), contacts)).all()
    assert np.isnan(inertial_strides(time, motion, contacts[:2])).all()  # the offset is not known of two rests
    struck = motion.copy()
    struck[STANCE + 10 : STANCE + 30, 0] = 16.0 * GRAVITY
    found = inertial_strides(time, struck, contacts)
    assert np.isnan(found[0])
    assert found[1] == pytest.approx(1.2, rel=0.02)
    assert len(inertial_strides(np.zeros(0), np.zeros((0, 6)), [])) == 0


@pytest.mark.parametrize(
    ("name", "stride", "speed"),
    [("recordings/moticon_walk_a.txt", 1.4656, 1.1229), ("laboratory/moticon_slow.txt", 1.0473, 0.5148)],
)
def test_strides_and_speed_of_real_walks_agree_with_the_makers_report(real_data, name, stride, speed):
    """The report is the maker's own estimate, as no recording comes with a truth; both feet walked the same way."""
    analysis = analyse(real_data / name)
    walk = analysis.metrics["gait"]
    assert walk["stride_length_m"] == pytest.approx(stride, rel=0.04)
    assert walk["walking_speed_m_s"] == pytest.approx(speed, rel=0.04)
    left, right = (np.nanmean([s["stride_length_m"] for s in analysis.feet[side].used]) for side in ("left", "right"))
    assert left == pytest.approx(right, rel=0.06)
    assert sum("inertial sensor" in note for note in analysis.metrics["warnings"]) == 2


def test_a_sensor_in_unknown_units_is_not_integrated(real_data, tmp_path):
    text = (real_data / "recordings/moticon_walk_a.txt").read_text().replace("angular X[dps]", "angular X[turns]")
    path = tmp_path / "walk.txt"
    path.write_text(text)
    analysis = analyse(path)
    assert analysis.metrics["gait"]["walking_speed_m_s"] is None
    assert any("turns, dps" in note for note in analysis.metrics["warnings"])
