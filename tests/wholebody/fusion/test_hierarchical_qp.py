import numpy as np
import pytest

from plantar.errors import InputError
from plantar.wholebody.fusion.hierarchical_qp import HierarchicalQP, JointLimits
from plantar.wholebody.fusion.hierarchy import fuse
from plantar.wholebody.tasks.task import Demand


def limits(size, torque=1e6, velocity=1e6, low=-1e6, high=1e6):
    """The same limits for every joint, none of which acts."""
    return JointLimits(*(np.full(size, value) for value in (torque, velocity, low, high)))


def stack(rng, size, rows=(3, 2, 4)):
    """Motions with a drift, and a force that acts in what one of them leaves."""
    levels = [
        [Demand(rng.normal(size=(m, size)), acceleration=rng.normal(size=m), drift=rng.normal(size=m))] for m in rows
    ]
    levels[1].append(Demand(rng.normal(size=(2, size)), force=rng.normal(size=2)))
    return levels


def largest_difference(one, other):
    return np.abs(one - other).max() / max(1.0, np.abs(other).max())


@pytest.mark.parametrize("base", [0, 6])
def test_where_no_limit_acts_the_motion_is_that_of_the_hierarchy(random_robot, base):
    for seed in range(20):
        rng = np.random.default_rng(seed)
        robot = random_robot(rng, 16, base)
        support = Demand(rng.normal(size=(6, 16)), acceleration=np.zeros(6), drift=rng.normal(size=6)) if base else None
        levels = stack(rng, 16)
        wanted = fuse(robot, levels, support)
        for shortcut in (True, False):
            qp = HierarchicalQP(limits(16 - base), shortcut)
            found = qp(robot, levels, support, np.zeros(16))
            assert largest_difference(found.acceleration, wanted.acceleration) < 1e-10
            assert largest_difference(found.torque, wanted.torque) < 1e-10
            assert not qp.limited
        assert support is None or largest_difference(found.support_force, wanted.support_force) < 1e-9


def test_near_a_singularity_it_damps_by_the_same_rule(random_robot):
    rng = np.random.default_rng(1)
    robot = random_robot(rng, 8)
    for share in (1e-1, 1e-2, 3e-3, 1e-4, 1e-7, 0.0):
        rows = rng.normal(size=(3, 8))
        rows[2] = rows[0] - rows[1] + share * rng.normal(size=8)
        levels = [[Demand(rows, acceleration=np.ones(3), drift=np.zeros(3))], *stack(rng, 8, (2, 2))]
        found = HierarchicalQP(limits(8), shortcut=False)(robot, levels)
        assert largest_difference(found.acceleration, fuse(robot, levels).acceleration) < 1e-7


@pytest.mark.parametrize("base", [0, 6])
def test_limits_are_kept_and_the_first_level_is_met_as_long_as_they_let_it(random_robot, base):
    acted = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        robot = random_robot(rng, 18, base)
        support = Demand(rng.normal(size=(6, 18)), acceleration=np.zeros(6), drift=np.zeros(6)) if base else None
        levels = stack(rng, 18)
        free = fuse(robot, levels, support)
        first = levels[0][0]
        need = np.abs(fuse(robot, levels[:1], support).torque)
        bound = JointLimits(
            np.maximum(1.05 * need, 0.7 * np.abs(free.torque).max()),
            *(limits(18 - base).__dict__[n] for n in ("velocity", "low", "high")),
        )
        qp = HierarchicalQP(bound)
        found = qp(robot, levels, support)
        acted += qp.limited
        assert (np.abs(found.torque) <= bound.torque).all()
        # The limits leave room for the first level, so it is met whatever the others ask for.
        assert np.abs(first.jacobian @ found.acceleration + first.drift - first.acceleration).max() < 1e-8
        total = robot.mass_matrix @ found.acceleration + robot.bias
        if support is not None:
            total -= support.jacobian.T @ found.support_force
            assert np.abs(support.jacobian @ found.acceleration).max() < 1e-9
        assert np.abs(total[base:] - found.torque).max() < 1e-7
    assert acted > 10


def test_a_lower_level_never_costs_a_higher_one_also_where_limits_act(random_robot):
    for seed in range(20):
        rng = np.random.default_rng(seed)
        robot = random_robot(rng, 12)
        levels = stack(rng, 12)
        torque = 0.5 * np.abs(fuse(robot, levels[:1]).torque).max()
        qp = HierarchicalQP(limits(12, torque=max(torque, 1.1 * np.abs(robot.bias).max())))
        rows = [d.jacobian for d in levels[0]]
        alone = rows[0] @ qp(robot, levels[:1]).acceleration
        together = rows[0] @ qp(robot, levels).acceleration
        assert largest_difference(together, alone) < 1e-8


def test_the_best_compromise_is_that_of_a_general_solver(random_robot):
    """One level and limits of torques: the residual is the smallest that any motion within them has."""
    from scipy.optimize import lsq_linear

    rng = np.random.default_rng(5)
    robot = random_robot(rng, 6)
    rows, wanted = rng.normal(size=(4, 6)), 20.0 * rng.normal(size=4)
    torque = 8.0
    found = HierarchicalQP(limits(6, torque=torque))(robot, [[Demand(rows, acceleration=wanted, drift=np.zeros(4))]])
    inverse = np.linalg.inv(robot.mass_matrix)
    best = lsq_linear(rows @ inverse, wanted + rows @ inverse @ robot.bias, (-torque, torque), tol=1e-14)
    residual = rows @ found.acceleration - wanted
    assert 0.5 * residual @ residual == pytest.approx(best.cost, rel=1e-8)


def test_a_level_whose_rows_are_taken_already_changes_nothing(random_robot):
    rng = np.random.default_rng(9)
    robot = random_robot(rng, 8)
    levels = stack(rng, 8, (3, 2))
    qp = HierarchicalQP(limits(8, torque=0.9 * np.abs(fuse(robot, levels).torque).max()), shortcut=False)
    again = [*levels[:1], [Demand(2.0 * levels[0][0].jacobian, acceleration=np.ones(3))], *levels[1:]]
    assert largest_difference(qp(robot, again).torque, qp(robot, levels).torque) < 1e-9


def test_a_joint_slows_down_before_its_end_and_keeps_its_speed(random_robot):
    robot = random_robot(np.random.default_rng(6), 3)
    robot.velocity = np.zeros(3)
    bound = limits(3, velocity=2.0, low=-0.5, high=0.5)
    qp, step = HierarchicalQP(bound), 1e-3
    position = robot.joint_positions
    for _ in range(2000):
        level = [Demand(np.eye(3), acceleration=np.array([30.0, -30.0, 1.0]), drift=np.zeros(3))]
        acceleration = qp(robot, [level]).acceleration
        robot.velocity = robot.velocity + step * acceleration
        position += step * robot.velocity
        assert (np.abs(robot.velocity) <= 2.0 + 1e-9).all()
        assert (np.abs(position) <= 0.5).all()
    assert np.allclose(position, [0.5, -0.5, 0.5], atol=1e-3)


def test_accelerations_are_bounded_where_a_task_asks_for_too_much(random_robot):
    robot = random_robot(np.random.default_rng(10), 4)
    bound = JointLimits(*(np.full(4, v) for v in (1e6, 1e6, -1e6, 1e6)), acceleration=20.0)
    level = [Demand(np.eye(4), acceleration=np.array([500.0, -30.0, 5.0, 0.0]), drift=np.zeros(4))]
    assert np.allclose(HierarchicalQP(bound)(robot, [level]).acceleration, [20.0, -20.0, 5.0, 0.0])


def test_limits_that_nothing_keeps_give_way_in_their_order(random_robot):
    """Gravity needs more than the speed's limit leaves torque for: torques stay within, the joint moves on."""
    robot = random_robot(np.random.default_rng(7), 4)
    robot.velocity = np.full(4, 3.0)
    bound = limits(4, torque=0.5, velocity=1e-3)
    level = [Demand(np.eye(4), acceleration=np.zeros(4), drift=np.zeros(4))]
    found = HierarchicalQP(bound)(robot, [level])
    assert (np.abs(found.torque) <= 0.5).all()
    assert np.isfinite(found.acceleration).all()
    pushed = np.linalg.solve(robot.mass_matrix, found.torque - robot.bias)
    assert np.allclose(found.acceleration, pushed, atol=1e-6)


def test_torques_are_continuous_where_limits_begin_to_act(random_robot):
    rng = np.random.default_rng(8)
    robot = random_robot(rng, 12)
    levels = stack(rng, 12, (3, 2, 2))
    qp = HierarchicalQP(limits(12, torque=1.2 * np.abs(fuse(robot, levels).torque).max()))

    def jump(count):
        torques, limited = [], 0
        for share in np.linspace(0.0, 6.0, count):
            asked = levels[2][0]
            pulled = [Demand(asked.jacobian, acceleration=share * asked.acceleration, drift=asked.drift)]
            torques.append(qp(robot, [*levels[:2], pulled]).torque)
            limited += qp.limited
        return np.abs(np.diff(torques, axis=0)).max(), limited

    coarse, limited = jump(201)
    fine, _ = jump(401)
    assert limited > 20
    assert 0.0 < fine < 0.6 * coarse


def test_bad_limits_are_refused():
    with pytest.raises(InputError, match="torque"):
        limits(2, torque=0.0)
    with pytest.raises(InputError, match="range of positions"):
        limits(2, low=1.0, high=-1.0)
