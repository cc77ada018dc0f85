import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.gait.feet.posture_compensation import PostureCompensation

COM = np.array([0.0, 0.0, 0.8])
FOOT = np.array([0.1, 0.2, 0.05])
LEVEL = np.eye(3)


def updated(compensation: PostureCompensation, *now: object) -> tuple[np.ndarray, np.ndarray]:
    """Corrections after a tick."""
    compensation.update(*now)
    return compensation.shift.copy(), compensation.turn.copy()


def settle(compensation: PostureCompensation, airborne: bool, lean: np.ndarray, ticks: int = 400) -> tuple:
    for _ in range(ticks):
        result = updated(compensation, airborne, FOOT, FOOT, COM, COM, LEVEL, lean)
    return result


def test_a_body_as_commanded_needs_no_correction() -> None:
    shift, turn = settle(PostureCompensation(0.005), True, LEVEL)
    assert np.abs(shift).max() < 1e-15
    assert np.abs(turn).max() < 1e-15


def test_a_leaning_body_puts_its_foot_where_it_is_wanted_in_the_world() -> None:
    lean = np.asarray(Rotation.from_rotvec([0.05, -0.03, 0.0]).as_matrix())
    shift, turn = settle(PostureCompensation(0.005), True, lean)
    # The real body carries what it is commanded to: world = c + R_estimated R_command^T (command - c).
    assert COM + lean @ (FOOT + shift - COM) == pytest.approx(FOOT, abs=1e-9)
    assert lean @ np.asarray(Rotation.from_rotvec(turn).as_matrix()) == pytest.approx(LEVEL, abs=1e-4)


def test_a_sagging_body_lifts_its_foot() -> None:
    compensation = PostureCompensation(0.005)
    for _ in range(400):
        shift, _ = updated(compensation, True, FOOT, FOOT, COM, COM - [0.0, 0.0, 0.01], LEVEL, LEVEL)
    assert shift == pytest.approx([0.0, 0.0, 0.01])


def test_corrections_are_limited_fade_out_on_the_ground_and_start_anew() -> None:
    compensation = PostureCompensation(0.005)
    lean = np.asarray(Rotation.from_rotvec([0.8, 0.0, 0.0]).as_matrix())
    shift, turn = settle(compensation, True, lean)
    assert np.linalg.norm(shift) == pytest.approx(compensation.largest_shift)
    assert np.linalg.norm(turn) == pytest.approx(compensation.largest_turn)
    shift, turn = settle(compensation, False, lean)
    assert np.abs(shift).max() < 1e-9
    assert np.abs(turn).max() < 1e-9
    settle(compensation, True, lean)
    compensation.start()
    assert not compensation.shift.any()


def test_a_correction_comes_without_a_jump_in_speed() -> None:
    compensation = PostureCompensation(0.005)
    lean = np.asarray(Rotation.from_rotvec([0.05, 0.0, 0.0]).as_matrix())
    shifts = [updated(compensation, k < 200, FOOT, FOOT, COM, COM, LEVEL, lean)[0] for k in range(400)]
    assert np.abs(shifts).max() > 0.03
    assert np.abs(np.diff(shifts, axis=0)).max() < 2.5e-3
    airborne = np.diff(shifts, n=2, axis=0)[10:190]  # m/tick^2; at both ends the foot is on the ground
    assert np.abs(airborne).max() < 4.0 * 0.005**2


def test_a_foot_that_stands_beside_its_place_is_not_pulled_there_at_once() -> None:
    compensation, lean = PostureCompensation(0.005), np.asarray(Rotation.from_rotvec([0.05, 0.0, 0.0]).as_matrix())
    shift, _ = settle(compensation, True, lean)
    beside = np.array([0.0, 0.06, 0.02])
    commanded, stands = FOOT + shift, FOOT - beside
    compensation.keep(beside)
    targets = []
    for _ in range(100):
        shift, _ = updated(compensation, False, stands, stands, COM, COM, LEVEL, lean)
        targets.append(stands + shift)
    steps = np.diff([commanded, *targets], axis=0)
    way = float(np.abs(commanded - stands).max())
    assert np.abs(steps).max() < 2.0 * way * 0.005 / compensation.fade  # an even fade takes half of that a tick
    assert targets[-1] == pytest.approx(stands, abs=1e-6)
    compensation.start()
    assert updated(compensation, True, FOOT, FOOT, COM, COM, LEVEL, LEVEL)[0] == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("ticks", [0, 1, 20, 41])
def test_a_foot_that_lands_before_the_correction_counts_is_not_commanded_away_at_once(ticks: int) -> None:
    compensation, beside = PostureCompensation(0.005), np.array([0.0, 0.06, 0.02])
    shift = np.zeros(3)
    for _ in range(ticks):
        shift, _ = updated(compensation, True, FOOT, FOOT, COM, COM, LEVEL, LEVEL)
    commanded, stands = FOOT + shift, FOOT - beside
    compensation.keep(beside)
    targets = [commanded]
    for _ in range(200):
        targets.append(stands + updated(compensation, False, stands, stands, COM, COM, LEVEL, LEVEL)[0])
    # What does not count yet goes out with the low pass, which takes a sixth a tick; a jump would be all of it.
    assert np.abs(np.diff(targets, axis=0)).max() < 0.2 * beside.max()
    assert targets[-1] == pytest.approx(stands, abs=1e-6)


def test_a_standing_foots_correction_fades_evenly_whatever_the_body_does() -> None:
    compensation, lean = PostureCompensation(0.005), np.asarray(Rotation.from_rotvec([0.05, -0.02, 0.0]).as_matrix())
    shift, turn = settle(compensation, True, lean)
    shift, turn = shift.copy(), turn.copy()
    ticks = round(compensation.fade / compensation.period)
    for k in range(1, ticks + 1):
        compensation.release()
        assert compensation.shift == pytest.approx((1.0 - k / ticks) * shift, abs=1e-12)
        assert compensation.turn == pytest.approx((1.0 - k / ticks) * turn, abs=1e-12)
    compensation.release()
    assert not compensation.shift.any()
    compensation.start()
    settle(compensation, True, lean)
    assert compensation.shift == pytest.approx(shift)
