import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from plantar import kernels
from plantar.errors import InputError
from plantar.gait.plan.vrp_plan import VrpPlan
from plantar.kernels.mechanics import pendulum

from ...examples import examples

OMEGA = 3.5


def random_plan(seed: int, knots: int = 8) -> VrpPlan:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.05, 1.2, knots))
    return VrpPlan(times.tolist(), rng.uniform(-1.0, 1.0, (knots, 2)), OMEGA, com=rng.uniform(-0.1, 0.1, 2))


def test_waypoints_of_a_constant_vrp_are_the_corrected_equation_4_14():
    r1, r2, length = np.array([0.0, 0.1]), np.array([0.2, -0.1]), 0.9
    plan = VrpPlan([0.0, length, length + 1e-9, 2 * length], [r1, r1, r2, r2], OMEGA)
    end = plan.dcm_waypoints[2]  # at the start of the second step
    start = plan.dcm_waypoints[0]
    corrected = r1 + math.exp(-OMEGA * length) * (end - r1)
    printed = r1 + math.exp(OMEGA * length) * (end + r1)
    assert np.allclose(start, corrected, atol=1e-7)
    assert not np.allclose(start, printed, atol=1e-2)


@examples(30)
@given(st.integers(0, 10**6))
def test_dcm_and_com_satisfy_their_equations(seed):
    plan = random_plan(seed)
    step = 1e-5
    for time in np.linspace(plan.times[0] + 1e-3, plan.times[-1] + 0.5, 57):
        if np.abs(np.array(plan.times) - time).min() < 2 * step:
            continue
        now, before, after = plan.at(time), plan.at(time - step), plan.at(time + step)
        assert np.allclose(now.dcm_velocity, OMEGA * (now.dcm - now.vrp), atol=1e-9)  # T 4.12
        assert np.allclose(now.com_velocity, OMEGA * (now.dcm - now.com), atol=1e-9)  # T 4.10
        assert np.allclose(now.com_acceleration, OMEGA**2 * (now.com - now.vrp), atol=1e-9)  # T 4.1
        assert np.allclose((after.dcm - before.dcm) / (2 * step), now.dcm_velocity, atol=1e-6)
        assert np.allclose((after.com - before.com) / (2 * step), now.com_velocity, atol=1e-6)


def test_com_agrees_with_a_numerical_integration():
    plan = random_plan(3)
    start = plan.at(plan.times[0])

    def pendulum(time: float, state: np.ndarray) -> np.ndarray:
        return np.concatenate([state[2:], OMEGA**2 * (state[:2] - plan.at(time).vrp)])

    end = plan.times[2]
    solution = solve_ivp(
        pendulum,
        (plan.times[0], end),
        np.concatenate([start.com, start.com_velocity]),
        rtol=1e-10,
        atol=1e-12,
        max_step=0.01,
    )
    assert np.allclose(solution.y[:2, -1], plan.at(end).com, atol=1e-7)


def test_the_plan_ends_at_rest_and_is_continuous():
    plan = random_plan(5)
    assert np.allclose(plan.at(plan.times[-1]).dcm, plan.vrps[-1], atol=1e-15)
    far = plan.at(plan.times[-1] + 20.0)
    assert np.allclose(far.com, plan.vrps[-1], atol=1e-12)
    for time in plan.times[1:]:
        a, b = plan.at(time - 1e-9), plan.at(time + 1e-9)
        assert np.allclose(a.dcm, b.dcm, atol=1e-6)
        assert np.allclose(a.com, b.com, atol=1e-6)


def test_a_thousand_steps_stay_finite_and_consistent():
    rng = np.random.default_rng(0)
    times: list[float] = [0.0]
    points: list[np.ndarray] = [np.zeros(2)]
    for k in range(1000):
        point = np.array([0.2 * k, 0.09 * (-1) ** k]) + rng.uniform(-0.05, 0.05, 2)
        times += [times[-1] + 0.3, times[-1] + 1.2]
        points += [point, point]
    plan = VrpPlan(times, points, OMEGA)
    assert np.isfinite(plan.dcm_waypoints).all()
    # forward from each waypoint with the closed solution: no growth by e^(w t) over the plan
    for i in range(0, len(times) - 1, 97):
        rate = (plan.vrps[i + 1] - plan.vrps[i]) / (times[i + 1] - times[i])
        shift = plan.dcm_waypoints[i] - plan.vrps[i] - rate / OMEGA
        ahead = plan.vrps[i + 1] + rate / OMEGA + math.exp(OMEGA * (times[i + 1] - times[i])) * shift
        assert np.allclose(ahead, plan.dcm_waypoints[i + 1], atol=1e-9)


@pytest.mark.parametrize(
    ("times", "points"),
    [
        ([0.0], [[0, 0]]),
        ([0.0, 0.0], [[0, 0], [1, 0]]),
        ([0.0, 1.0], [[0, 0, 0], [1, 0, 0]]),
        ([0.0, 1.0], [[0, math.nan], [1, 0]]),
    ],
)
def test_bad_knots_are_refused(times, points):
    with pytest.raises(InputError):
        VrpPlan(times, points, OMEGA)


def test_both_forms_of_the_kernel_agree_to_the_last_bit():
    rng = np.random.default_rng(0)
    source = kernels.python_form("pendulum")
    for _ in range(20):
        knots = np.cumsum(rng.uniform(0.1, 1.0, 6))
        given = (float(rng.uniform(1.0, 5.0)), knots, rng.normal(size=(6, 2)), *rng.normal(size=(2, 5, 2)), (0.3, -0.1))
        compiled = pendulum.PendulumCourse(*given)
        interpreted = source.PendulumCourse(*given)
        for time in rng.uniform(knots[0] - 0.5, knots[-1], 30).tolist():  # to and fro
            assert len(compiled.at(time)) == len(interpreted.at(time)) == 6
            assert np.array_equal(compiled.at(time), interpreted.at(time))
        assert np.array_equal(compiled.end(), interpreted.end())
