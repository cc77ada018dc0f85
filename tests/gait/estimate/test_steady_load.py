"""Which feet stand still, over the loads of a walk."""

from plantar.kernels.gait.gyro_bias import SteadyLoad

PERIOD, WEIGHT = 0.005, 800.0


def counted(shares: list[float]) -> list[tuple[bool, bool]]:
    """Which feet count, by the share of the weight that the left one carries in each tick."""
    steady = SteadyLoad(0.8, PERIOD / 0.5, 0.05 * WEIGHT)
    out = []
    for share in shares:
        loads = share * WEIGHT, (1.0 - share) * WEIGHT
        steady.update(*loads)
        assert steady.left in (0.0, loads[0])
        assert steady.right in (0.0, loads[1])
        out.append((steady.left > 0.0, steady.right > 0.0))
    return out


def test_both_feet_of_a_robot_that_stands_count():
    assert all(row == (True, True) for row in counted([0.5] * 100))


def test_only_the_foot_that_carries_nearly_all_counts_in_a_step():
    over = [0.5 + 0.5 * k / 60 for k in range(61)]  # in 0.3 s
    rows = counted([0.5] * 100 + over + [1.0] * 150 + over[::-1])
    moving = rows[110:130] + rows[336:372]
    assert not any(left or right for left, right in moving)
    assert all(left for left, _ in rows[140:315])


def test_both_ends_of_a_step_are_cut_at_the_same_load():
    rise = [0.001 * k for k in range(1001)]
    rows = counted([0.0] * 500 + rise + [1.0] * 500 + rise[::-1])
    first = next(k for k, (left, _) in enumerate(rows) if left)
    assert first == 500 + 800
    assert [left for left, _ in rows[2001:]].index(False) == 201


def test_feet_that_stand_again_count_again():
    rows = counted([1.0] * 100 + [1.0 - 0.5 * k / 60 for k in range(61)] + [0.5] * 600)
    assert rows[165] == (False, False)
    assert rows[-1] == (True, True)
