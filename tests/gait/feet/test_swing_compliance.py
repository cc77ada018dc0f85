"""How a swinging sole comes down on ground that it sees."""

import numpy as np
import pytest

from plantar import hex_layout
from plantar.gait.contact.ground_map import GroundMapSettings, GroundView
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.gait.feet.swing_compliance import SwingCompliance
from plantar.mechanics.rotation import rotation_from_vector

LAYOUT = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
PERIOD = 0.005
X, Y = LAYOUT.positions[:, 0], LAYOUT.positions[:, 1]


def swing(gains: ComplianceGains, double_support: float = 0.3) -> SwingCompliance:
    return SwingCompliance(LAYOUT, gains, TouchdownGains(), GroundMapSettings(), double_support)


def test_close_to_the_ground_an_edge_goes_down_no_faster_than_the_sole() -> None:
    gains = ComplianceGains()
    compliance = swing(gains)
    slow = compliance.turn_rate(0.0, (0.005, 0.0))
    assert slow * np.hypot(*np.ptp(LAYOUT.outline, axis=0)) / 2 == pytest.approx(gains.touch_speed)
    assert compliance.turn_rate(0.03, (0.005, 0.0)) == gains.turn_rate
    assert compliance.turn_rate(0.0, (0.1, 0.0)) == gains.turn_rate  # a wedge slides in
    assert compliance.turn_rate(0.0, (0.17, 0.0), even=False) == slow  # from a block's edge to the floor behind it


@pytest.mark.parametrize("height", [0.06, 0.04, 0.02])
def test_the_swing_slows_down_and_touches_at_a_crawl(height: float) -> None:
    gains = ComplianceGains()
    compliance = swing(gains)
    compliance.begin()
    speeds = []
    for _ in range(400):
        seen = GroundView(height, height, (0.0, 0.0)) if height < compliance.ground.settings.sensing_range else None
        drop = compliance.descent(seen, 0.1, 0.0, 0.5, PERIOD)
        speeds.append(drop / PERIOD)
        height -= drop
        if height <= 0.0:
            break
    assert height <= 0.0
    assert max(speeds) <= gains.top_speed + 1e-9
    assert speeds[-1] < 2.0 * gains.touch_speed
    assert np.diff(speeds).max() <= gains.acceleration * PERIOD + 0.02


def test_a_foot_that_still_moves_forward_keeps_its_clearance() -> None:
    gains = ComplianceGains()
    compliance = swing(gains)
    compliance.begin()
    height = 0.04
    for _ in range(400):
        height -= compliance.descent(GroundView(height, height, None), 0.1, 0.1, 0.5, PERIOD)
    assert height == pytest.approx(gains.clearance, abs=1e-3)


@pytest.mark.parametrize(("haste", "late"), [(0.0, False), (1.0, True)])
def test_only_a_hasty_foot_waits_for_its_plan_to_come_down(haste: float, late: bool) -> None:
    compliance, height, planned = swing(ComplianceGains()), 0.04, 0.1
    compliance.begin(haste)
    for _ in range(40):
        height -= compliance.descent(GroundView(height, height, None), planned, 0.1, 0.3, PERIOD)
    assert (height > 0.018) == late  # 20 mm by the plan


def test_a_hurried_foot_is_down_sooner() -> None:
    lasted = []
    for hurries in (False, True):
        compliance, height, left = swing(ComplianceGains()), 0.03, 0.1
        compliance.begin()
        if hurries:
            compliance.hasten()
        ticks = 0
        while height > 0.0005:
            height -= compliance.descent(GroundView(height, height, None), 0.3, 0.0, left, PERIOD)
            left -= PERIOD
            ticks += 1
        lasted.append(ticks * PERIOD)
    usual, quick = lasted
    assert quick < 0.85 * usual


@pytest.mark.parametrize(("left", "double", "quick"), [(0.32, 0.3, False), (0.18, 0.1, True)])
def test_a_sole_goes_slowly_where_ground_is_not_even_unless_it_would_be_late(
    left: float, double: float, quick: bool
) -> None:
    gains = ComplianceGains()
    compliance, height, speeds = swing(gains, double), 0.025, []
    compliance.begin()
    while height > 0.001:
        drop = compliance.descent(GroundView(height, height, None, even=False), 0.3, 0.0, left, PERIOD)
        speeds.append(drop / PERIOD)
        height, left = height - drop, left - PERIOD
    assert (max(speeds) > gains.rough_speed + 1e-9) == quick
    assert max(speeds) < 2.0 * gains.rough_speed
    assert not quick or len(speeds) * PERIOD < 0.7 * 0.025 / gains.rough_speed


def test_touchdown_has_hysteresis_and_the_load_is_held() -> None:
    gains = ComplianceGains()
    compliance = swing(gains)
    compliance.begin()
    assert not any(compliance.update_load(load) for load in (5.0, -3.0, 8.0, 6.0))
    assert [compliance.update_load(40.0) for _ in range(3)][-1]
    assert compliance.update_load(10.0)  # above half the threshold
    load, height = 0.0, 0.001
    for _ in range(800):
        height -= compliance.yielding(load, compliance.touchdown.hold_force, 0.0, PERIOD)
        load = max(0.0, -2e5 * height)
    assert load == pytest.approx(compliance.touchdown.hold_force, abs=2.0)


def test_a_descent_is_over_before_weight_is_put_on_the_foot() -> None:
    for height in (0.006, 0.012, 0.03):
        gains = ComplianceGains()
        compliance = swing(gains)
        compliance.begin()
        left, speed = 0.35, 0.0
        while height > 0.0:
            drop = compliance.descent(GroundView(height, height, None), 0.1, 0.0, left, PERIOD)
            speed, height, left = drop / PERIOD, height - drop, left - PERIOD
        assert 0.0 < left < 0.2
        assert speed < 1.5 * gains.late_speed_ratio * gains.touch_speed


@pytest.mark.parametrize("height", [0.005, 0.01, 0.02])
def test_a_sole_that_sees_its_ground_late_is_there_before_weight_is_put_on_it(height: float) -> None:
    gains = ComplianceGains()
    compliance, left, drop = swing(gains), 0.23, 0.0
    compliance.begin()
    while height > gains.margin:
        drop = compliance.descent(GroundView(height, height, None), 0.3, 0.0, left, PERIOD)
        height, left = height - drop, left - PERIOD
    assert left > 0.03
    assert drop / PERIOD < 0.03  # of 0.3 m/s at first


@pytest.mark.parametrize(("single", "double"), [(0.9, 0.3), (0.5, 0.1)])
def test_a_descent_is_over_when_weight_is_put_on_the_foot_in_quick_steps(single: float, double: float) -> None:
    compliance = swing(ComplianceGains(), double)
    compliance.begin()
    height, left = 0.05, 0.5 * single
    while height > 0.0:
        height -= compliance.descent(GroundView(height, height, None), 0.1, 0.0, left, PERIOD)
        left -= PERIOD
    assert left > -0.3 * double


def test_a_foot_past_the_ground_that_it_sees_goes_down_faster() -> None:
    speeds = []
    for past in (0.0, 0.002, 0.004):
        compliance = swing(ComplianceGains())
        compliance.begin()
        for _ in range(50):
            drop = compliance.descent(GroundView(-past, -past, None), 0.1, 0.0, 0.5, PERIOD)
        speeds.append(drop)
    assert np.diff(speeds).min() > 0.0


@pytest.mark.parametrize("even", [True, False])
def test_ground_that_is_not_one_plane_is_come_down_to_slowly(even: bool) -> None:
    """What few taxels see of a block's edge and the floor behind it jumps by the height of the block."""
    gains = ComplianceGains()
    compliance = swing(gains)
    fastest = 0.0
    for k in range(80):
        jumps = 0.02 if k % 10 < 5 else 0.01
        drop = compliance.descent(GroundView(jumps, jumps, None, even), 0.2, 0.0, 0.3, PERIOD)
        fastest = max(fastest, drop / PERIOD)
    assert (fastest <= gains.rough_speed + 1e-9) is not even
    assert fastest > 0.5 * gains.rough_speed


def test_a_load_is_held_while_the_body_moves_and_grows_gently() -> None:
    gains = ComplianceGains()
    compliance = swing(gains)
    compliance.begin()
    assert (
        compliance.holding(0.0)
        == compliance.touchdown.touch_force
        < compliance.holding(1.0)
        == compliance.touchdown.hold_force
    )
    load, height = 20.0, -1e-4
    for _ in range(400):
        height += 0.002 * PERIOD - compliance.yielding(load, compliance.touchdown.hold_force, 0.0, PERIOD)
        load = max(0.0, -2e5 * height)
    assert load == pytest.approx(compliance.touchdown.hold_force, abs=1.0)


def test_a_foot_that_lost_the_ground_comes_back() -> None:
    compliance = swing(ComplianceGains())
    compliance.begin()
    near, far = (compliance.yielding(0.0, 30.0, above, PERIOD) for above in (0.0, 0.0003))
    assert 0.0 < near < far


@pytest.mark.parametrize("seen", [True, False])
def test_turning_goes_to_the_slope_or_level_at_a_limited_rate(seen: bool) -> None:
    gains = ComplianceGains()
    compliance = swing(gains)
    compliance.begin()
    rotation, rates = rotation_from_vector(np.array([0.1, 0.0, 0.0]) * (not seen)), [np.zeros(3)]
    for _ in range(200):
        normal = rotation.T @ np.array([-0.1, 0.05, 1.0])
        slope = (-normal[0] / normal[2], -normal[1] / normal[2]) if seen else None
        turn = compliance.turn(rotation, GroundView(0.02, 0.02, slope), PERIOD)
        rates.append(turn / PERIOD)
        rotation = rotation @ rotation_from_vector(turn)
    for _ in range(20):
        rates.append(compliance.turn(rotation, None, PERIOD) / PERIOD)
    assert not rates[-1].any()  # at rest once it sees no ground
    assert np.linalg.norm(rates, axis=1).max() <= (gains.turn_rate if seen else 0.1 / gains.turning) + 1e-9
    assert np.linalg.norm(np.diff(rates, axis=0), axis=1).max() < 50.0 * PERIOD  # rad/s^2 of H1's ankle
    up = rotation[:, 2] / rotation[2, 2]
    assert up[:2] == pytest.approx([-0.1, 0.05] if seen else [0.0, 0.0], abs=1e-3)


@pytest.mark.parametrize("by_law", ["plane", "wrench"])
def test_ground_that_comes_into_sight_does_not_make_the_foot_jump(by_law: str) -> None:
    compliance = swing(ComplianceGains(law=by_law))
    compliance.begin()
    speeds, heights = [], [None] * 60 + [0.04] * 2 + [0.01] * 10 + [None] * 5 + [0.03] * 20
    for height in heights:
        seen = None if height is None else GroundView(height, height, None)
        compliance.ground._distance[:] = np.inf if height is None else height
        compliance.update_load(0.0)
        drop = (
            compliance.damped(0.3, 0.5, PERIOD)
            if compliance.by_wrench
            else compliance.descent(seen, 0.3, 0.1, 0.5, PERIOD)
        )
        speeds.append(drop / PERIOD)
    assert max(speeds) > 0.25
    assert min(speeds[60:]) < 0.05  # it brakes, and soon
    assert np.abs(np.diff(speeds)).max() < 20.0 * PERIOD  # m/s^2


def by_wrench(compliance: SwingCompliance, height: float, plan: float, left: float) -> tuple[float, float, float]:
    """Height in m at which the virtual force stops a swing, speed in m/s when it touches, and the time in s of that."""
    stopped, time, reach = 0.0, 0.0, compliance.ground.settings.sensing_range
    while height > 0.0:
        compliance.ground._distance[:] = height if height < reach else np.inf
        assert not compliance.update_load(0.0)
        drop = compliance.damped(plan, left - time, PERIOD)
        stopped = height if compliance.stopped and not stopped else stopped
        height, time = height - drop, time + PERIOD
    return stopped, drop / PERIOD, time


def test_the_virtual_force_damps_and_stops_a_swing() -> None:
    gains = ComplianceGains(law="wrench", stop=0.9)
    compliance = swing(gains)
    compliance.begin()
    stopped, speed, time = by_wrench(compliance, 0.06, 0.2, 0.6)
    reach = compliance.ground.settings.sensing_range
    assert stopped == pytest.approx((1.0 - gains.stop) * reach, abs=2e-3)  # T 4.31
    assert speed < 0.05
    assert time < 0.6  # before the plan puts weight on it
    assert swing(ComplianceGains(law="wrench")).stopped is False


def test_the_virtual_force_ends_with_load() -> None:
    compliance = swing(ComplianceGains(law="wrench"))
    compliance.begin()
    compliance.ground._distance[:] = 0.01
    assert not compliance.update_load(0.0)
    in_the_air = compliance.damped(0.2, 1.0, PERIOD)
    for _ in range(5):
        landed = compliance.update_load(100.0)
    assert landed
    assert compliance._wrench.tolist()[:3] == pytest.approx([0.0, 0.0, compliance.force])  # T 4.30 (corrected)
    assert in_the_air < 0.2 * PERIOD


@pytest.mark.parametrize(("further", "waits"), [(0.5, True), (1.5, False)])
def test_a_sole_waits_until_its_rim_has_passed_an_edge_that_its_taxels_passed(further: float, waits: bool) -> None:
    compliance = swing(ComplianceGains())
    compliance.begin()
    edge, period = 0.1, 0.001  # m to go as the last taxel passes the edge of a block 30 mm high
    rim = X.min() - LAYOUT.outline[:, 0].min()

    def down(remaining: float, distance: float) -> float:
        return compliance.descent(GroundView(distance, distance, None), 0.05, remaining, 1.0, period)

    for i in range(50):
        down(edge + 0.001 * (50 - i), 0.02)
    for share in np.linspace(0.0, further, 100):
        last = down(edge - share * rim, 0.05)
    assert last <= 0.0 if waits else last > 0.0
