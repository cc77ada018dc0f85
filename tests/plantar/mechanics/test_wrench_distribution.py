"""The distribution against quadprog, against its own definition, and where it cannot be met."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plantar.errors import InputError
from plantar.mechanics.contact import Contact
from plantar.mechanics.wrench_cone import Rectangle, wrench_cone
from plantar.mechanics.wrench_distribution import (
    DistributionState,
    DistributionWeights,
    Program,
    WrenchDistribution,
    WrenchShare,
)

WEIGHT = 640.0
SOLE = Rectangle(-0.09, 0.14, -0.07, 0.07)


def turn(yaw: float, roll: float = 0.0, pitch: float = 0.0) -> np.ndarray:
    c, s = math.cos(yaw), math.sin(yaw)
    about_z = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = math.cos(pitch), math.sin(pitch)
    about_y = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    c, s = math.cos(roll), math.sin(roll)
    return about_z @ about_y @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


NAMES = ("left", "right", "left hand", "right hand")

Problem = tuple[dict[str, Contact], np.ndarray, np.ndarray, dict[str, float]]


def random_problem(rng: np.random.Generator, count: int) -> Problem:
    """Feet anywhere within 10 m, at any heading, on slopes, on any part of the sole; hands at any height and turn."""
    yaw = rng.uniform(-math.pi, math.pi)
    place, body = np.array([*rng.uniform(-10.0, 10.0, 2), rng.uniform(-0.5, 0.5)]), turn(yaw)
    contacts = {}
    for i, name in enumerate(NAMES[:count]):
        middle, half = rng.uniform(-0.05, 0.05, 2), rng.uniform(0.005, 0.13, 2)
        (x, y), (a, b) = middle, half
        offset = [rng.uniform(-0.15, 0.15), 0.1 - 0.2 * i, rng.uniform(-0.05, 0.05)]
        tilt = 0.2
        if i >= 2:
            offset, tilt = [rng.uniform(0.2, 0.5), 0.3 - 0.6 * (i - 2), rng.uniform(0.5, 1.2)], 1.4
        contacts[name] = Contact(
            place + body @ offset,
            turn(yaw + rng.uniform(-0.3, 0.3), *rng.uniform(-tilt, tilt, 2)),
            Rectangle(x - a, x + a, y - b, y + b),
            rng.uniform(0.3, 1.0),
            None if rng.random() < 0.5 else (x, y),
        )
    force = WEIGHT * np.array([*rng.normal(0.0, 0.15, 2), rng.uniform(0.3, 1.6)])
    point = place + body @ [0.0, 0.0, 0.87]
    zmp = place + body @ [*rng.uniform(-0.25, 0.25, 2), 0.0]
    moment = np.cross(zmp - point, force) + np.array([0.0, 0.0, rng.normal(0.0, 10.0)])
    parts = rng.uniform(0.0, 1.0, count)
    return contacts, np.concatenate([force, moment]), point, dict(zip(contacts, parts / parts.sum(), strict=True))


def by_quadprog(program: Program) -> np.ndarray:
    quadprog = pytest.importorskip("quadprog")
    solution = quadprog.solve_qp(program.hessian, -program.gradient, -program.constraints.T, -program.upper)[0]
    return (solution * program.unit).reshape(-1, 6)


def value(program: Program, wrenches: np.ndarray) -> float:
    v = wrenches.ravel() / program.unit
    return float(0.5 * v @ program.hessian @ v + program.gradient @ v)


def rows(share: WrenchShare) -> np.ndarray:
    return np.array(list(share.wrenches.values())).reshape(-1, 6)


def net_about(contacts: dict[str, Contact], wrenches: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Net wrench (6,) in the world about a point, by forces and cross products."""
    total = np.zeros(6)
    for contact, wrench in zip(contacts.values(), wrenches, strict=True):
        force, moment = contact.rotation @ wrench[:3], contact.rotation @ wrench[3:]
        total += [*force, *(moment + np.cross(contact.position - point, force))]
    return total


def compare(contacts_count: int, count: int, seed: int) -> set[DistributionState]:
    rng = np.random.default_rng(seed)
    distribution = WrenchDistribution(WEIGHT)
    seen = set()
    for _ in range(count):
        contacts, wrench, point, shares = random_problem(rng, contacts_count)
        share = distribution.solve(contacts, wrench, point, shares)
        seen.add(share.state)
        assert list(share.wrenches) == list(contacts)
        program = distribution.program(contacts, wrench, point, shares)
        expected = by_quadprog(program)
        # Three contacts or more push against each other almost for free: there two solvers agree in the cost alone.
        assert np.abs(rows(share) - expected).max() < (1e-6 if contacts_count < 3 else 1e-3)
        assert value(program, rows(share)) == pytest.approx(value(program, expected), rel=1e-11)
        for contact, one in zip(contacts.values(), rows(share), strict=True):
            assert (wrench_cone(contact.rectangle, contact.friction) @ one).max() < 1e-6
            assert one[2] > 15.0 - 1e-6
        middle = np.mean([c.position for c in contacts.values()], axis=0)
        wanted = np.concatenate([wrench[:3], wrench[3:] + np.cross(point - middle, wrench[:3])])
        assert share.error == pytest.approx(net_about(contacts, rows(share), middle) - wanted, abs=1e-8)
    return seen


@pytest.mark.parametrize("contacts", [1, 2, 3, 4])
def test_it_is_what_quadprog_finds(contacts):
    assert compare(contacts, 200, contacts) == {DistributionState.TRACKED, DistributionState.SATURATED}


@pytest.mark.long
@pytest.mark.parametrize("contacts", [1, 2, 3, 4])
def test_it_is_what_quadprog_finds_5000_times(contacts):
    compare(contacts, 5_000, 10 + contacts)


def cost(weights: DistributionWeights, problem: Problem, wrenches: np.ndarray) -> float:
    """The cost as the module's docstring defines it, written out."""
    contacts, wrench, point, shares = problem
    middle = np.mean([c.position for c in contacts.values()], axis=0)
    wanted = np.concatenate([wrench[:3], wrench[3:] + np.cross(point - middle, wrench[:3])])
    unit = WEIGHT * np.array([1.0, 1.0, 1.0, 0.1, 0.1, 0.1])
    error = (net_about(contacts, wrenches, middle) - wanted) / unit
    total = weights.net * error @ error
    for contact, one in zip(contacts.values(), wrenches / unit, strict=True):
        total += weights.friction * (one[0] ** 2 + one[1] ** 2 + one[5] ** 2)
        if len(contacts) > 1:
            x, y = np.array(contact.preferred or contact.rectangle.center) / 0.1
            total += weights.ankle * ((one[3] - y * one[2]) ** 2 + (one[4] + x * one[2]) ** 2)
    wished, carried = np.array([shares[name] for name in contacts]), wrenches[:, 2] / WEIGHT
    off = np.outer(wished, carried) - np.outer(carried, wished)
    total += weights.pressure * 0.5 * float((off**2).sum())
    level = [(c.rotation @ one[:3])[:2] / WEIGHT for c, one in zip(contacts.values(), wrenches, strict=True)]
    beside = [wished[j] * level[i] - wished[i] * level[j] for i in range(len(level)) for j in range(i)]
    total += weights.horizontal * sum(float(f @ f) for f in beside)
    return float(total)


def test_no_wrench_nearby_costs_less():
    rng = np.random.default_rng(3)
    weights = DistributionWeights(net=100.0, ankle=5.0, pressure=2.0, friction=0.5)
    distribution = WrenchDistribution(WEIGHT, weights)
    for k in range(80):
        problem = random_problem(rng, 1 + k % 4)
        contacts = problem[0]
        best = rows(distribution.solve(*problem))
        lowest = cost(weights, problem, best)
        for scale in (1e-2, 1.0, 30.0):
            other = best + scale * rng.normal(size=best.shape) * [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]
            # Back into the cones: more normal force in the middle of each rectangle.
            for contact, one in zip(contacts.values(), other, strict=True):
                x, y = contact.rectangle.center
                inward = np.array([0.0, 0.0, 1.0, y, -x, 0.0])
                facets = wrench_cone(contact.rectangle, contact.friction)
                one += inward * max(0.0, ((facets @ one) / -(facets @ inward)).max(), 15.0 - one[2])
            assert cost(weights, problem, other) >= lowest - 1e-9 * max(1.0, lowest)


def test_feet_at_other_heights_do_not_press_against_each_other():
    # A step's two feet, one 2.3 mm lower, with the ZMP between them beside their line: without its cost the share had
    # 40 N between the feet, which hips 0.8 m above them pay with 32 N m.
    left = Contact(np.array([0.203, 0.109, 0.0]), np.eye(3), SOLE)
    right = Contact(np.array([0.403, -0.107, -0.0023]), np.eye(3), SOLE)
    wrench, point = np.array([23.2, -24.8, WEIGHT, 0.0, 0.0, 0.0]), np.array([0.256, 0.061, -0.001])
    found = WrenchDistribution(WEIGHT).solve({"left": left, "right": right}, wrench, point, left_share(0.794))
    assert found.wrenches["left"][:2] == pytest.approx(0.794 * wrench[:2], abs=1.0)
    assert found.wrenches["right"][:2] == pytest.approx(0.206 * wrench[:2], abs=1.0)


def two_feet() -> dict[str, Contact]:
    return {side: Contact(np.array([0.0, y, 0.0]), np.eye(3), SOLE) for side, y in (("left", 0.105), ("right", -0.105))}


def left_share(left: float) -> dict[str, float]:
    return {"left": left, "right": 1.0 - left}


def test_the_result_does_not_depend_on_where_the_robot_stands_and_heads():
    wrench, point = np.array([20.0, -10.0, 650.0, 25.0, -12.0, 3.0]), np.array([0.02, 0.01, 0.87])
    here = WrenchDistribution(WEIGHT).solve(two_feet(), wrench, point, left_share(0.3))
    for yaw, shift in ((1.0, [10.0, -10.0, 0.0]), (-3.0, [-10.0, 3.0, 0.7])):
        r = turn(yaw)
        moved = {
            side: replace(c, position=r @ c.position + shift, rotation=r @ c.rotation) for side, c in two_feet().items()
        }
        turned = np.concatenate([r @ wrench[:3], r @ wrench[3:]])
        there = WrenchDistribution(WEIGHT).solve(moved, turned, r @ point + shift, left_share(0.3))
        assert rows(there) == pytest.approx(rows(here), abs=1e-7)


def test_one_foot_takes_what_it_can():
    foot = {"left": two_feet()["left"]}
    place = foot["left"].position
    wrench = np.array([30.0, 10.0, 640.0, 20.0, -30.0, 2.0])
    share = WrenchDistribution(WEIGHT).solve(foot, wrench, place)
    assert share.state == DistributionState.TRACKED
    assert share.wrenches["left"] == pytest.approx(wrench, abs=0.01)
    far = WrenchDistribution(WEIGHT).solve(foot, [0.0, 0.0, 640.0, 300.0, 0.0, 0.0], place)
    assert far.state == DistributionState.SATURATED
    cop = far.center_of_pressure("left")
    assert cop[1] == pytest.approx(SOLE.y_max, abs=1e-9)


def test_weight_follows_the_zmp_and_each_foot_keeps_its_pressure_in_the_middle():
    feet = two_feet()
    middle = SOLE.center[0]
    for share_left in (0.2, 0.5, 0.9):
        y = 0.105 * (2.0 * share_left - 1.0)
        share = WrenchDistribution(WEIGHT).solve(
            feet, [0.0, 0.0, WEIGHT, WEIGHT * y, -WEIGHT * middle, 0.0], np.zeros(3), left_share(share_left)
        )
        assert share.wrenches["left"][2] == pytest.approx(share_left * WEIGHT, rel=1e-3)
        for side in feet:
            assert share.center_of_pressure(side) == pytest.approx([middle, 0.0], abs=1e-3)


def test_contradicting_constraints_give_the_least_violating_wrench():
    """A rectangle turned inside out by a safety offset carries nothing, yet the foot shall press with 15 N."""
    from scipy.optimize import minimize

    feet = two_feet()
    crossed = Rectangle(0.02, -0.02, 0.01, -0.01)
    for contacts in (
        {"left": replace(feet["left"], rectangle=crossed)},
        {side: replace(c, rectangle=crossed) for side, c in feet.items()},
        {"left": feet["left"], "right": replace(feet["right"], rectangle=crossed)},
    ):
        distribution = WrenchDistribution(WEIGHT)
        wrench = np.array([5.0, 0.0, 600.0, 10.0, 0.0, 0.0])
        share = distribution.solve(contacts, wrench, np.zeros(3))
        assert share.state == DistributionState.INFEASIBLE
        assert share.violation > 0.0
        p = distribution.program(contacts, wrench, np.zeros(3))

        def violation(v: np.ndarray, p: Program = p) -> float:
            return float(np.sum(np.maximum(0.0, p.constraints @ v - p.upper) ** 2))

        ours = violation(rows(share).ravel() / p.unit)
        best = min(
            minimize(violation, start, method="BFGS", options={"gtol": 1e-14}).fun
            for start in np.random.default_rng(0).normal(0.0, 0.1, (5, len(p.unit)))
        )
        assert ours <= best * 1.001 + 1e-15
        # It is no dead end: the next request is solved as if nothing had happened.
        after = distribution.solve(two_feet(), wrench, np.zeros(3))
        fresh = WrenchDistribution(WEIGHT).solve(two_feet(), wrench, np.zeros(3))
        assert after.state == fresh.state == DistributionState.TRACKED
        assert rows(after) == pytest.approx(rows(fresh), abs=1e-7)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("where", ["wrench", "point", "share", "position", "rotation", "rectangle", "preferred"])
@pytest.mark.parametrize("feet", [1, 2, 3])
def test_numbers_that_are_not_finite_give_the_bodys_weight(feet, where, bad):
    hand = Contact(np.array([0.4, 0.0, 0.9]), turn(0.0, 0.3), SOLE)
    contacts = dict(list({**two_feet(), "hand": hand}.items())[:feet])
    wrench, point = np.array([0.0, 0.0, WEIGHT, 0.0, 0.0, 0.0]), np.zeros(3)
    shares = {name: (k + 1.0) / (feet * (feet + 1) / 2) for k, name in enumerate(contacts)}
    distribution = WrenchDistribution(WEIGHT)
    before = distribution.solve(contacts, wrench, point, shares)
    broken = contacts["left"]
    if where == "wrench":
        wrong = (contacts, np.array([0.0, 0.0, WEIGHT, bad, 0.0, 0.0]), point, shares)
    elif where == "point":
        wrong = (contacts, wrench, np.array([0.0, 0.0, bad]), shares)
    elif where == "share":
        wrong = (contacts, wrench, point, {**shares, "left": bad})
    else:
        value = {
            "position": np.array([0.0, bad, 0.0]),
            "rotation": np.full((3, 3), bad),
            "rectangle": Rectangle(-0.1, bad, -0.1, 0.1),
            "preferred": (0.0, bad),
        }[where]
        wrong = ({**contacts, "left": replace(broken, **{where: value})}, wrench, point, shares)
    share = distribution.solve(*wrong)
    assert share.state == DistributionState.INVALID
    assert np.isfinite(rows(share)).all()
    assert rows(share)[:, 2].sum() == pytest.approx(WEIGHT)
    again = distribution.solve(contacts, wrench, point, shares)
    assert again.state == before.state
    assert rows(again) == pytest.approx(rows(before), abs=1e-9)


def test_no_contact_no_wrench():
    share = WrenchDistribution(WEIGHT).solve({}, [0.0, 0.0, 640.0, 0.0, 0.0, 0.0], np.zeros(3))
    assert share.state == DistributionState.AIRBORNE
    assert share.wrenches == {}
    with pytest.raises(InputError, match="one contact or more"):
        WrenchDistribution(WEIGHT).program({}, np.zeros(6), np.zeros(3))


def test_shares_of_other_contacts_are_refused():
    for shares in ({}, {"left": 1.0}, {"left": 0.5, "hand": 0.5}, {"left": 0.5, "right": 0.25, "hand": 0.25}):
        with pytest.raises(InputError, match="allowed: for left, right"):
            WrenchDistribution(WEIGHT).solve(two_feet(), np.zeros(6), np.zeros(3), shares)


def test_shares_that_add_up_to_nothing_give_the_bodys_weight_evenly():
    share = WrenchDistribution(WEIGHT).solve(two_feet(), np.zeros(6), np.zeros(3), {"left": 0.0, "right": 0.0})
    assert share.state == DistributionState.INVALID
    assert rows(share)[:, 2].tolist() == [0.5 * WEIGHT, 0.5 * WEIGHT]


def test_a_stool_of_four_legs_carries_the_wanted_shares():
    """Their normal forces are not determined by the net wrench: the wanted proportion decides."""
    legs = {
        name: Contact(np.array([x, y, 0.0]), np.eye(3), Rectangle(-0.01, 0.01, -0.01, 0.01))
        for name, x, y in (("a", 0.2, 0.2), ("b", -0.2, 0.2), ("c", -0.2, -0.2), ("d", 0.2, -0.2))
    }
    wrench = [0.0, 0.0, WEIGHT, 0.0, 0.0, 0.0]
    even = WrenchDistribution(WEIGHT).solve(legs, wrench, np.zeros(3))
    assert rows(even)[:, 2] == pytest.approx(np.full(4, 0.25 * WEIGHT), rel=1e-3)
    diagonal = {"a": 0.4, "b": 0.1, "c": 0.4, "d": 0.1}
    share = WrenchDistribution(WEIGHT).solve(legs, wrench, np.zeros(3), diagonal)
    assert share.state == DistributionState.TRACKED
    assert rows(share)[:, 2] / WEIGHT == pytest.approx(list(diagonal.values()), rel=1e-3)


def test_contacts_that_are_a_line_or_a_point_are_contacts():
    for rectangle in (Rectangle(-0.1, 0.1, 0.02, 0.02), Rectangle(0.03, 0.03, 0.02, 0.02)):
        foot = {"left": Contact(np.zeros(3), np.eye(3), rectangle)}
        share = WrenchDistribution(WEIGHT).solve(foot, [0.0, 0.0, WEIGHT, 0.0, 0.0, 0.0], np.zeros(3))
        assert share.state == DistributionState.SATURATED
        cop = share.center_of_pressure("left")
        assert cop[1] == pytest.approx(0.02, abs=1e-9)


@pytest.mark.parametrize(
    ("weight", "force", "word"), [(0.0, 15.0, "weight"), (math.nan, 15.0, "weight"), (600.0, -1.0, "minimum force")]
)
def test_a_distribution_of_nothing_is_refused(weight, force, word):
    with pytest.raises(InputError, match=word):
        WrenchDistribution(weight, minimum_force=force)
    with pytest.raises(InputError, match="net"):
        DistributionWeights(net=0.0)
