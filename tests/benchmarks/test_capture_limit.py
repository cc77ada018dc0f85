"""The bound on captured pushes against linear programs with every ZMP written out, and against simulated pushes."""

import itertools
import math

import numpy as np
import pytest
from capture_limit import CaptureLimits, Instant, capture_limit, mirrored
from periodic_walk import PeriodicWalk, capture_map
from scipy.integrate import solve_ivp
from scipy.optimize import linprog

from plantar.errors import InputError
from plantar.geometry.polygon import convex_hull, signed_margin

SOLE = np.array([[-0.08, -0.04], [0.12, -0.04], [0.12, 0.05], [-0.08, 0.05]])
REGION = np.array([[-0.3, 0.15], [0.3, 0.15], [0.3, 0.3], [0.2, 0.4], [-0.2, 0.4], [-0.3, 0.3]])
OMEGA, MASS = 3.5, 50.0


def robot(**changes) -> CaptureLimits:
    usual = {
        "double_support": 0.1,
        "swing_speed": 1.5,
        "swing_acceleration": 20.0,
        "swing_sideways": 2 / 3,
        "steps": 2,
        "times": 5,
    }
    return CaptureLimits(MASS, OMEGA, SOLE, REGION, 0.35, 0.9, **(usual | changes))


WALK = PeriodicWalk(OMEGA, 0.1, 0.2, 0.5, 0.1)


def simulated(instant: Instant, push: np.ndarray, supports: list[tuple[float, np.ndarray]]) -> np.ndarray:
    """DCM (2,) after a push of no duration and some time at each ZMP, by integration."""
    dcm = instant.dcm + push / (MASS * OMEGA)
    for duration, zmp in supports:
        found = solve_ivp(lambda _, x, z=zmp: OMEGA * (x - z), (0.0, duration), dcm, rtol=1e-10, atol=1e-12)
        dcm = found.y[:, -1]
    return dcm


def written_out(limits: CaptureLimits, instant: Instant, toward: np.ndarray, steps) -> tuple[float, list, list]:
    """The largest push for given times and shares, by a linear program forward in time: impulse, ZMPs, places.

    Its variables are the impulse, each step, and in each support a point of each sole that it presses on.
    """
    soles = [limits.sole, mirrored(limits.sole)] if instant.side == "left" else [mirrored(limits.sole), limits.sole]
    regions = [limits.region, mirrored(limits.region)]
    regions = regions if instant.side == "left" else regions[::-1]
    columns = itertools.count(1)

    def point():
        return [next(columns), next(columns)]

    places = [None] + [point() for _ in steps]  # from the foot before
    rows_le, rows_eq, supports = [], [], []

    def inside(polygon, pair, sign=1.0):
        hull = convex_hull(polygon)
        for a, b in zip(hull, np.roll(hull, -1, axis=0), strict=True):
            n = np.array([b[1] - a[1], a[0] - b[0]])
            rows_le.append(({pair[0]: sign * n[0], pair[1]: sign * n[1]}, n @ a))

    def pressed(share, i):
        """A point of the soles of feet i and i + 1, as columns with weights."""
        here, there = point(), point()
        inside(soles[i % 2], here)
        inside(soles[(i + 1) % 2], there)
        weights = [(here, 1.0 - share), (there, share)]
        weights += [(p, 1.0) for p in places[1 : i + 1]]
        return weights + ([(places[i + 1], share)] if share else [])

    # Forward in time: the DCM is constants + weights on columns.
    dcm = [(None, 1.0)]
    clock = 0.0
    for i, step in enumerate(steps):
        single = step.time - clock
        clock = step.time + limits.double_support
        for share, duration in ((0.0, single), (step.share, limits.double_support if i < len(steps) - 1 else 0.0)):
            if duration == 0.0:
                continue
            zmp, grown = pressed(share, i), math.exp(OMEGA * duration)
            supports.append((duration, zmp))
            dcm = [(p, grown * c) for p, c in dcm] + [(p, (1.0 - grown) * c) for p, c in zmp]
        inside(regions[(i + 1) % 2], places[i + 1])
        for angle in 2.0 * math.pi * np.arange(16) / 16:
            u = np.array([math.cos(angle), math.sin(angle)])
            row = {places[i + 1][k]: u[k] for k in (0, 1)}
            row |= {places[i][k]: u[k] for k in (0, 1)} if i else {}
            rows_le.append((row, limits.swing_speed * single + (0.0 if i else u @ instant.swing)))
            # To the side a third less: the ellipse is a circle where y is stretched.
            v, swing = (np.zeros(2) if i else at / (1.0, 2 / 3) for at in (instant.velocity, instant.swing))
            reach = limits.swing_acceleration * single**2 - v @ v / limits.swing_acceleration
            stretched = {column: value / (1.0 if column % 2 else 2 / 3) for column, value in row.items()}
            rows_le.append((stretched, max(reach, 0.0) * math.sqrt(3.0) / 10.0 + u @ (0.5 * single * v + swing)))
    last = pressed(steps[-1].share, len(steps) - 1)
    for k in (0, 1):
        row, right = {}, 0.0
        for pair, c in dcm:
            if pair is None:
                right -= c * instant.dcm[k]
                row[0] = row.get(0, 0.0) + c * toward[k] / (MASS * OMEGA)
            else:
                row[pair[k]] = row.get(pair[k], 0.0) + c
        for pair, c in last:
            row[pair[k]] = row.get(pair[k], 0.0) - c
        rows_eq.append((row, right))
    size = next(columns)

    def dense(rows):
        out = np.zeros((len(rows), size))
        for r, (row, _) in enumerate(rows):
            for column, value in row.items():
                out[r, column] = value
        return out, [right for _, right in rows]

    goal = np.zeros(size)
    goal[0] = -1.0
    a, b = dense(rows_le)
    a_eq, b_eq = dense(rows_eq)
    found = linprog(goal, a, b, a_eq, b_eq, bounds=[(0.0, None)] + [(None, None)] * (size - 1))
    assert found.status == 0
    zmps = [(d, sum(c * found.x[pair] for pair, c in z)) for d, z in supports]
    return -found.fun, zmps, [found.x[p] for p in places[1:]]


CASES = [(phase, side, angle) for phase, side in ((0.3, "left"), (0.8, "right")) for angle in (0.3, 2.0, 4.4)]


@pytest.mark.parametrize(("phase", "side", "angle"), CASES)
def test_its_steps_capture_the_push_when_simulated(phase, side, angle):
    limits, instant = robot(), WALK.instant(phase, side)
    toward = np.array([math.cos(angle), math.sin(angle)])
    found = capture_limit(limits, instant, toward)
    if not found.steps:
        support = limits.sole if side == "left" else mirrored(limits.sole)
        assert abs(signed_margin(support, instant.dcm + found.impulse * toward / MASS / OMEGA)) < 1e-6
        return
    most, zmps, places = written_out(limits, instant, toward, found.steps)
    assert found.impulse == pytest.approx(most, rel=1e-5)
    dcm = simulated(instant, most * toward, zmps)
    feet = np.cumsum([np.zeros(2), *places], axis=0)[-2:]
    soles = [limits.sole, mirrored(limits.sole)] if side == "left" else [mirrored(limits.sole), limits.sole]
    last = len(places) - 1
    hull = convex_hull(np.vstack([feet[0] + soles[last % 2], feet[1] + soles[(last + 1) % 2]]))
    assert signed_margin(hull, dcm) > -1e-4


def test_random_plans_never_capture_more():
    limits, instant, rng = robot(swing_acceleration=math.inf), WALK.instant(0.6), np.random.default_rng(0)
    toward = np.array([0.6, -0.8])
    most, caught = capture_limit(limits, instant, toward).impulse, 0
    soles, regions = (limits.sole, mirrored(limits.sole)), (mirrored(limits.region), limits.region)
    for _ in range(1500):
        impulse = most * rng.uniform(0.2, 1.5)
        dcm, at, swing = instant.dcm + impulse * toward / (MASS * OMEGA), np.zeros(2), instant.swing
        for i in range(rng.integers(1, 3)):
            total = rng.uniform(max(0.35, instant.elapsed if i == 0 else 0.0), 0.5)
            left = total - (instant.elapsed if i == 0 else 0.0)
            zmp = at + rng.dirichlet(0.2 * np.ones(4)) @ soles[i % 2]
            dcm = zmp + math.exp(OMEGA * left) * (dcm - zmp)
            place = at + rng.dirichlet(0.3 * np.ones(6)) @ regions[i % 2]
            place = place if np.linalg.norm(place - swing) <= limits.swing_speed * left else None
            if place is None:
                break
            hull = convex_hull(np.vstack([at + soles[i % 2], place + soles[(i + 1) % 2]]))
            if signed_margin(hull, dcm) >= 0.0:
                caught += 1
                assert impulse <= most * (1.0 + 1e-6)
            swing, at = at, place
            zmp = rng.dirichlet(0.2 * np.ones(len(hull))) @ hull
            dcm = zmp + math.exp(OMEGA * limits.double_support) * (dcm - zmp)
    assert caught > 20


def test_more_of_anything_captures_no_less():
    instant, toward = WALK.instant(0.4), np.array([0.5, -0.5])
    usual = capture_limit(robot(), instant, toward).impulse
    for change in ({"swing_speed": 3.0}, {"swing_acceleration": 40.0}, {"steps": 3, "times": 3}, {"landing": 0.0}):
        assert capture_limit(robot(**change), instant, toward).impulse >= usual * 0.999, change
    for change in (
        {"swing_speed": 0.5},
        {"swing_acceleration": 5.0},
        {"swing_sideways": 0.2},
        {"landing": 0.35},
        {"steps": 0},
        {"height": 0.3},
    ):
        assert capture_limit(robot(**change), instant, toward).impulse < usual, change


def test_both_sides_are_alike():
    for angle in (0.7, 2.9, 5.0):
        left = capture_limit(robot(), WALK.instant(0.3, "left"), (math.cos(angle), math.sin(angle)))
        right = capture_limit(robot(), WALK.instant(0.3, "right"), (math.cos(angle), -math.sin(angle)))
        assert left.impulse == pytest.approx(right.impulse, rel=1e-6)
        for a, b in zip(left.steps, right.steps, strict=True):
            assert a.time == b.time
            assert a.place == pytest.approx(mirrored(b.place), abs=1e-6)


def test_a_push_that_lasts_and_one_above_the_com_count_as_they_move_the_dcm():
    standing = Instant("left", np.zeros(2), np.array([0.0, -0.2]))
    at_once = capture_limit(robot(steps=0), standing, [1.0, 0.0]).impulse
    assert at_once == pytest.approx(0.12 * MASS * OMEGA)
    above = capture_limit(robot(steps=0, height=0.2), standing, [1.0, 0.0]).impulse
    assert above == pytest.approx(at_once / (1.0 + 0.2 * OMEGA**2 / 9.81))
    lasting = capture_limit(robot(steps=0, lasts=0.2), standing, [1.0, 0.0]).impulse
    # Against such a push the sole's edge holds the DCM still at its end: xi' = w (xi - edge) + F / (m w).
    dcm = 0.12 + (0.0 - 0.12) * math.exp(OMEGA * 0.2) + lasting / 0.2 / (MASS * OMEGA**2) * math.expm1(OMEGA * 0.2)
    assert dcm == pytest.approx(0.12, abs=1e-6)


def test_the_walk_repeats_itself():
    for walk in (WALK, PeriodicWalk(OMEGA, 0.0, 0.2, 0.5, 0.0, (0.02, 0.01))):
        begin, end = walk.instant(0.0), walk.instant(1.0)
        step = np.array([walk.length, -walk.width])
        after = walk.instant(0.0, "right")
        assert end.swing == pytest.approx(step)
        assert end.dcm - step == pytest.approx(after.dcm, abs=1e-12)
        assert begin.swing == pytest.approx([-walk.length, -walk.width])
    # In a double support the ZMP goes over at one speed.
    first = WALK.instant(0.0)
    from_foot, to_foot = first.swing + mirrored(WALK.zmp), np.array(WALK.zmp)

    def rate(time, dcm):
        return OMEGA * (dcm - from_foot - time / 0.1 * (to_foot - from_foot))

    found = solve_ivp(rate, (0.0, 0.1), first.dcm, rtol=1e-10, atol=1e-13)
    assert WALK.instant(0.1 / 0.6).dcm == pytest.approx(found.y[:, -1], abs=1e-8)


def test_the_map_has_a_cell_for_each_phase_and_direction():
    limits = robot(steps=1, times=3)
    found = capture_map(limits, WALK, directions=2, phases=3)
    assert found.shape == (3, 2)
    assert found[1, 1] == pytest.approx(capture_limit(limits, WALK.instant(1 / 3), [-1.0, 0.0]).impulse)


def test_one_who_falls_anyway_captures_nothing():
    falling = Instant("left", np.array([3.0, 0.0]), np.array([0.0, -0.2]))
    assert capture_limit(robot(), falling, [1.0, 0.0]) == (0.0, ())


def test_wrong_arguments_are_named():
    with pytest.raises(InputError, match="sole has no vertices"):
        CaptureLimits(MASS, OMEGA, np.empty((0, 2)), REGION, 0.3, 0.8)
    with pytest.raises(InputError, match=r"longest is 0\.2"):
        CaptureLimits(MASS, OMEGA, SOLE, REGION, 0.3, 0.2)
    with pytest.raises(InputError, match="swing_speed is 0"):
        robot(swing_speed=0.0)
    with pytest.raises(InputError, match="steps, times and shares"):
        robot(steps=9)
    with pytest.raises(InputError, match="direction has no length"):
        capture_limit(robot(), WALK.instant(0.0), [0.0, 0.0])
    with pytest.raises(InputError, match="phase of a step is 2"):
        WALK.instant(2.0)
    with pytest.raises(InputError, match="frequency of the walk"):
        capture_map(robot(), PeriodicWalk(3.0, 0.0, 0.2, 0.5, 0.1))
