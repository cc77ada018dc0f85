import numpy as np
import pytest

from plantar.wholebody.fusion.hierarchy import fuse
from plantar.wholebody.fusion.null_space import mass_factor, null_space_projector, null_space_torques, task_torque
from plantar.wholebody.tasks.task import Demand


def motions(rng, size, rows, acceleration=False):
    """A level each of random rows; forces, or accelerations with a drift."""
    levels = []
    for m in rows:
        jacobian = rng.normal(size=(m, size))
        if acceleration:
            levels.append([Demand(jacobian, acceleration=rng.normal(size=m), drift=rng.normal(size=m))])
        else:
            levels.append([Demand(jacobian, force=rng.normal(size=m))])
    return levels


@pytest.mark.parametrize("consistent", [True, False])
@pytest.mark.parametrize("acceleration", [True, False])
def test_the_recursive_form_equals_the_augmented_one(random_robot, consistent, acceleration):
    for seed in range(20):
        rng = np.random.default_rng(seed)
        robot = random_robot(rng, 14)
        levels = motions(rng, 14, (3, 2, 4, 3, 6), acceleration)
        levels[3][0].jacobian[2] = levels[1][0].jacobian[0]  # a row that a higher task has already
        one = null_space_torques(robot, levels, consistent=consistent)
        other = null_space_torques(robot, levels, projection="augmented", consistent=consistent)
        assert np.abs(one.torque - other.torque).max() < 1e-9 * np.abs(other.torque).max()
        assert np.abs(one.acceleration - other.acceleration).max() < 1e-9 * np.abs(other.acceleration).max()


def test_only_consistent_projectors_of_all_rows_keep_priorities_strict(random_robot):
    """With the last task's rows alone the third task disturbs one above it; without M every task does.

    T says after 3.8 that tasks i - a for a > 1 are disturbed. Of the product as T 3.7 prints it the first task's
    projector acts last, so the first is safe and it is those between that are disturbed.
    """
    rng = np.random.default_rng(3)
    robot = random_robot(rng, 10)
    levels = motions(rng, 10, (3, 2, 3))

    def disturbed(place, **options):
        rows = levels[place][0].jacobian
        before = null_space_torques(robot, levels[: place + 1], **options).acceleration
        return np.linalg.norm(rows @ (null_space_torques(robot, levels, **options).acceleration - before))

    for place in (0, 1):
        assert disturbed(place) < 1e-12
        assert disturbed(place, projection="augmented") < 1e-12
        assert disturbed(place, consistent=False) > 1e-2
    assert disturbed(0, projection="successive") < 1e-12
    assert disturbed(1, projection="successive") > 1e-2


def test_forces_alone_give_what_the_hierarchy_gives(random_robot):
    rng = np.random.default_rng(4)
    robot = random_robot(rng, 9)
    levels = motions(rng, 9, (3, 4, 2))
    assert np.allclose(null_space_torques(robot, levels).torque, fuse(robot, levels).torque, rtol=1e-10)


def test_a_motion_by_itself_is_met(random_robot):
    rng = np.random.default_rng(5)
    robot = random_robot(rng, 8)
    level = motions(rng, 8, (4,), acceleration=True)
    asked = level[0][0]
    found = null_space_torques(robot, level).acceleration
    assert np.allclose(asked.jacobian @ found + asked.drift, asked.acceleration)
    assert np.allclose(task_torque(robot, asked), robot.mass_matrix @ found)


def test_a_projector_is_one_and_lets_nothing_through_that_moves_the_task(random_robot):
    rng = np.random.default_rng(6)
    robot = random_robot(rng, 7)
    rows = rng.normal(size=(3, 7))
    rows[2] = rows[0] + rows[1]  # singular
    through = null_space_projector(rows, mass_factor(robot.mass_matrix))
    assert np.allclose(through @ through, through)
    assert np.linalg.matrix_rank(through) == 5
    assert np.abs(rows @ np.linalg.solve(robot.mass_matrix, through)).max() < 1e-12
    plain = null_space_projector(rows)
    assert np.allclose(plain, plain.T)
    assert np.abs(plain @ rows.T).max() < 1e-12


def test_a_support_stays_and_carries_the_base(random_robot):
    rng = np.random.default_rng(7)
    robot = random_robot(rng, 16, base=6)
    support = Demand(rng.normal(size=(6, 16)), acceleration=np.zeros(6), drift=rng.normal(size=6))
    found = null_space_torques(robot, motions(rng, 16, (3, 5)), support)
    assert np.allclose(support.jacobian @ found.acceleration, -support.drift)
    total = robot.mass_matrix @ found.acceleration + robot.bias - support.jacobian.T @ found.support_force
    assert np.allclose(total[:6], 0.0)
    assert np.allclose(total[6:], found.torque)


def test_silent_tasks_count_for_nothing(random_robot):
    rng = np.random.default_rng(8)
    robot = random_robot(rng, 6)
    levels = motions(rng, 6, (2, 2))
    found = null_space_torques(robot, [[None], levels[0], [], [*levels[1], None]])
    assert np.array_equal(found.torque, null_space_torques(robot, levels).torque)
    assert np.allclose(null_space_torques(robot, []).torque, robot.bias)
