"""The estimator against a robot whose motion is known in closed form: a base that sways over fixed feet."""

import math
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar import InputError, Percept, Reading, SoleLayout, hex_layout
from plantar.gait.estimate.dcm_filter import DcmFilter, DcmFilterRules
from plantar.gait.estimate.estimator import EstimatorGains, FloatingBaseEstimator, Posture
from plantar.gait.estimate.gyro_bias import GyroBias
from plantar.layouts.layout import Side

PERIOD, OMEGA = 0.005, 3.5
SOLE = hex_layout([[-0.1, -0.06], [0.12, -0.06], [0.12, 0.06], [-0.1, 0.06]])
FEET: dict[Side, NDArray[np.float64]] = {"left": np.array([0.0, 0.09, 0.0]), "right": np.array([0.0, -0.09, 0.0])}
START = {s: (*p.tolist(), 0.0) for s, p in FEET.items()}


@cache
def weights_of(layout: SoleLayout) -> NDArray[np.float64]:
    """Matrix (n, 3) that gives the least taxel shares of a load from their sum and their centre (x, y)."""
    return np.linalg.pinv(np.column_stack([np.ones(len(layout)), layout.positions[:, :2]]).T)


class Swaying:
    """Base pose over time; `posture` takes the time as its one joint. Somebody may lean on it with a force that moves
    the ZMP by so many metres, and that nothing feels."""

    def __init__(self, tilt: float, sway: float, leans: float = 0.0) -> None:
        self.tilt, self.sway, self.leans = tilt, sway, leans

    def rotation(self, time: float) -> NDArray[np.float64]:
        """About x, then about y of the world; written out, since it is asked for ten times a tick."""
        roll, pitch = 0.5 * self.tilt * math.sin(3.0 * time), self.tilt * math.sin(2.0 * time)
        a, b, c, d = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
        return np.array([[d, c * a, c * b], [0.0, b, -a], [-c, d * a, d * b]])

    def base(self, time: float) -> NDArray[np.float64]:
        return np.array([self.sway * math.sin(2.0 * time), self.sway * math.sin(2.5 * time), 0.8])

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        time = float(joint_positions[0])
        r, p = self.rotation(time), self.base(time)
        return Posture(
            com=np.array([0.0, 0.0, 0.05]),
            positions={s: r.T @ (FEET[s] - p) for s in FEET},
            rotations={s: r.T.copy() for s in FEET},
        )

    def com(self, time: float) -> NDArray[np.float64]:
        return self.base(time) + self.rotation(time) @ np.array([0.0, 0.0, 0.05])

    def gyro(self, time: float) -> NDArray[np.float64]:
        a, b = self.rotation(time), self.rotation(time + PERIOD)
        return np.asarray(Rotation.from_matrix(a.T @ b).as_rotvec() / PERIOD)

    def acceleration(self, time: float) -> NDArray[np.float64]:
        h = 1e-4
        return (self.com(time + h) - 2 * self.com(time) + self.com(time - h)) / h**2

    def percepts(self, time: float, layout: SoleLayout = SOLE) -> dict[Side, Percept]:
        """Soles that feel the ZMP of the pendulum at this time."""
        zmp = self.com(time)[:2] - self.acceleration(time)[:2] / OMEGA**2 + np.array([self.leans, 0.0])
        left = float(np.clip((zmp[1] + 0.09) / 0.18, 0.0, 1.0))
        out: dict[Side, Percept] = {}
        for side, share in (("left", left), ("right", 1.0 - left)):
            x, y = zmp[0], zmp[1] - (left * 0.09 - (1 - left) * 0.09)
            load = 800.0 * share * (weights_of(layout) @ np.array([1.0, x, y]))
            out[side] = Percept(layout, Reading(time, load), force_threshold=-1e9)
        return out


def follow(robot, duration, noise=0.0, bias=0.0, identified=None, known=None):
    """Worst errors after the first second: orientation in rad, CoM in m, CoM velocity in m/s."""
    rng = np.random.default_rng(0)
    estimator = FloatingBaseEstimator(robot, OMEGA, PERIOD, START, gyro_bias=identified, dcm_filter=known)
    worst = np.zeros(3)
    for k in range(round(duration / PERIOD)):
        time = k * PERIOD
        specific = robot.acceleration(time) + np.array([0.0, 0.0, 9.81])
        state = estimator.update(
            np.array([time]),
            robot.gyro(time - PERIOD) + noise * rng.standard_normal(3) + bias,
            robot.rotation(time).T @ specific + 10 * noise * rng.standard_normal(3),
            robot.percepts(time),
            robot.acceleration(time)[:2],
        )
        if time > 1.0:
            turn = Rotation.from_matrix(state.rotation_base_to_world.T @ robot.rotation(time)).magnitude()
            velocity = (robot.com(time + 1e-5) - robot.com(time - 1e-5)) / 2e-5
            errors = [
                turn,
                float(np.abs(state.com - robot.com(time)).max()),
                float(np.abs(state.com_velocity[:2] - velocity[:2]).max()),
            ]
            worst = np.maximum(worst, errors)
    return tuple(worst.tolist())


def test_follows_a_swaying_base():
    turn, com, velocity = follow(Swaying(tilt=0.04, sway=0.01), 8.0)
    assert turn < 2e-3
    assert com < 3e-3
    assert velocity < 5e-3


def test_a_filter_learns_of_a_push_that_nothing_feels():
    leans = Swaying(tilt=0.0, sway=0.01, leans=0.02)
    plain = follow(leans, 1.6)[2]
    turn, com, velocity = follow(leans, 1.6, known=DcmFilter(DcmFilterRules(), OMEGA, PERIOD))
    assert turn < 2e-3
    assert com < 2e-3
    assert velocity < 0.3 * plain


def test_noise_and_gyro_bias_stay_bounded():
    turn, com, _ = follow(Swaying(tilt=0.0, sway=0.005), 20.0, noise=2e-3, bias=1e-3)
    assert turn < 0.012  # bias / gravity gain = 5e-3 rad, plus noise
    assert com < 0.02


def test_a_bias_that_is_identified_does_no_harm():
    plain, _, _ = follow(Swaying(tilt=0.02, sway=0.005), 10.0, noise=2e-3, bias=5e-3)
    turn, com, _ = follow(
        Swaying(tilt=0.02, sway=0.005), 10.0, noise=2e-3, bias=5e-3, identified=GyroBias(PERIOD, 20.0, 0.05, 0.25, 6e-4)
    )
    assert plain > 0.015  # towards bias / gravity gain = 0.025 rad
    assert turn < 4e-3
    assert com < 4e-3


def test_a_foot_in_the_air_finds_its_zero():
    robot = Swaying(0.0, 0.0)
    estimator = FloatingBaseEstimator(robot, OMEGA, PERIOD, START)
    rng = np.random.default_rng(0)
    up = np.array([0.0, 0.0, 9.81])
    loads = []
    for k in range(400):
        noise = np.clip(rng.normal(0.0, 5.0, len(SOLE)), 0.0, None)  # taxels report no pull: their noise has a mean
        feet: dict[Side, Percept] = {
            "left": Percept(SOLE, Reading(0.0, np.full(len(SOLE), 800.0 / len(SOLE)))),
            "right": Percept(SOLE, Reading(0.0, noise)),
        }
        state = estimator.update(np.zeros(1), np.zeros(3), up, feet, airborne="right" if k > 100 else None)
        loads.append(state.loads["right"])
    assert np.mean(loads[:100]) > 60.0
    assert np.mean(loads[200:]) < 10.0
    assert state.loads["left"] == pytest.approx(800.0)


def test_an_airborne_robot_keeps_finite_answers():
    robot = Swaying(0.0, 0.0)
    estimator = FloatingBaseEstimator(robot, OMEGA, PERIOD, START)
    empty: dict[Side, Percept] = {s: Percept(SOLE, Reading(0.0, np.zeros(len(SOLE)))) for s in FEET}
    up = np.array([0.0, 0.0, 9.81])
    for _ in range(100):
        state = estimator.update(np.zeros(1), np.zeros(3), up, empty)
    assert state.zmp is None
    assert np.isfinite(state.com).all()
    assert np.isfinite(state.com_velocity).all()


def test_an_observer_that_runs_away_with_the_pendulum_is_refused():
    robot = Swaying(0.0, 0.0)
    for bandwidth in (0.1, 1.0, OMEGA):
        with pytest.raises(InputError, match=r"estimator\.observer.*more than 3\.5 rad/s"):
            FloatingBaseEstimator(robot, OMEGA, PERIOD, START, EstimatorGains(observer=bandwidth))
    FloatingBaseEstimator(robot, OMEGA, PERIOD, START, EstimatorGains(observer=1.01 * OMEGA))
