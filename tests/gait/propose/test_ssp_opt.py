"""SSP-Opt against the paper's cost as it is printed, a general solver of quadratic programs, and L-BFGS-B."""

import math

import daqp
import numpy as np
import pytest
from scipy.optimize import minimize

from plantar.errors import InputError
from plantar.gait.balance.ankle_strategy import target_dcms
from plantar.gait.propose.ssp_opt import SspProblem, StepRegionRules, StepWeights, footstep_region, solve_ssp
from plantar.geometry.polygon import convex_hull

WEIGHTS = StepWeights()
BOX = np.array([[-0.2, 0.15], [0.2, 0.15], [0.2, 0.27], [-0.2, 0.27]])


def problem(**changes) -> SspProblem:
    """A robot that steps in place, right foot down, with some of it changed."""
    usual = {
        "omega": 3.44,
        "dcm": [0.0, 0.02],
        "vrp": [0.0, 0.03],
        "offset": [0.0, 0.0],
        "stance": [0.0, 0.0],
        "elapsed": 0.3,
        "target": (0.0, 0.2, 0.8),
        "nominal": (0.0, 0.2, 0.8),
        "region": BOX,
        "shortest": 0.4,
        "longest": 1.7,
        "next_stride": [0.0, -0.2],
        "next_duration": 0.8,
        "double_support": 0.1,
        "confidence": 1.0,
    }
    return SspProblem(**(usual | changes))


def drawn(rng: np.random.Generator, polygon: bool = True) -> SspProblem:
    """A problem of all sorts."""
    at, size = rng.uniform(-0.3, 0.3, 2), rng.uniform(0.02, 0.3, 2)
    region = at + size * BOX / 0.2 if not polygon else convex_hull(at + size * rng.normal(size=(7, 2)))
    near = region.mean(axis=0)
    elapsed, shortest = rng.uniform(0.0, 0.7), rng.uniform(0.05, 0.6)
    return problem(
        omega=rng.uniform(2.8, 7.0),
        dcm=rng.uniform(-0.2, 0.2, 2),
        vrp=rng.uniform(-0.1, 0.1, 2),
        offset=rng.uniform(-0.05, 0.05, 2),
        stance=rng.uniform(-0.1, 0.1, 2),
        elapsed=elapsed,
        target=(*(near + rng.uniform(-0.2, 0.2, 2)), rng.uniform(0.3, 1.5)),
        nominal=(*(near + rng.uniform(-0.2, 0.2, 2)), rng.uniform(0.3, 1.5)),
        region=region,
        shortest=shortest,
        longest=max(elapsed, shortest) + rng.uniform(0.0, 1.5),
        next_stride=rng.uniform(-0.3, 0.3, 2),
        next_duration=rng.uniform(0.3, 1.0),
        double_support=rng.choice([0.0, rng.uniform(0.02, 0.8)]),
        confidence=rng.choice([0.0, 1.0, rng.uniform()]),
    )


def dcm_at(p: SspProblem, time: float):
    """DCM (2,) at a time of the single support (K 28)."""
    at = np.asarray(p.vrp) - p.offset
    return at + math.exp(p.omega * (time - p.elapsed)) * (np.asarray(p.dcm) - at)


def printed_cost(p: SspProblem, place, tau: float) -> float:
    """K 28-31 as printed, with the weights of K Table 1."""
    time = math.log(tau) / p.omega
    wanted = target_dcms(
        place, p.stance, p.next_stride, p.next_duration, p.double_support, p.offset, p.omega
    ).single_end
    reached = dcm_at(p, time)
    total = WEIGHTS.dynamics * 0.5 * float(np.sum((wanted - reached) ** 2))
    bounds = [math.exp(p.omega * t) for t in (p.shortest, p.longest)]
    w_u = 1.0 / np.ptp(np.asarray(p.region), axis=0)
    w_tau = 1.0 / max(bounds[1] - bounds[0], 1e-9 * bounds[1])
    for share, (x, y, t) in ((p.confidence, p.nominal), (1.0 - p.confidence, p.target)):
        off = np.asarray(place) - (x, y)
        square = w_u @ off**2 + w_tau * (tau - math.exp(p.omega * t)) ** 2
        total += share * 0.5 * float(square)
    return total


def bounds_of(p: SspProblem) -> tuple[float, float]:
    """Least and largest time."""
    return max(p.shortest, p.elapsed), max(p.longest, p.elapsed)


def by_daqp(p: SspProblem) -> tuple[np.ndarray, float]:
    """Footstep and time by a general solver, from the printed cost in (u, tau / tau_max)."""
    low, high = (math.exp(p.omega * t) for t in bounds_of(p))

    def cost(z):
        return printed_cost(p, z[:2], z[2] * high)

    # A quadratic is known by its values, here at 0 (s = 1, that its logarithm exists), along the axes and between.
    zero, e = np.array([0.0, 0.0, 1.0]), np.diag([1.0, 1.0, 1.0])
    f0 = cost(zero)
    hess = np.array(
        [[cost(zero + e[i] + e[j]) - cost(zero + e[i]) - cost(zero + e[j]) + f0 for j in range(3)] for i in range(3)]
    )
    grad = np.array([cost(zero + e[i]) - f0 - 0.5 * hess[i, i] for i in range(3)]) - hess @ zero
    region = np.asarray(p.region)
    along = np.roll(region, -1, axis=0) - region
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
    rows = np.vstack([np.eye(3)[2:], np.column_stack([normals, np.zeros(len(region))])])
    upper = np.r_[1.0, np.sum(normals * region, axis=1)]
    lower = np.r_[low / high, np.full(len(region), -1e30)]
    scale = np.sqrt(np.diag(hess))
    z, _, flag, _ = daqp.solve(
        hess / np.outer(scale, scale), grad / scale, np.ascontiguousarray(rows / scale), upper, lower, primal_tol=1e-12
    )
    assert flag == 1
    z = z / scale
    return z[:2], high * z[2]


@pytest.mark.parametrize("seed", range(60))
def test_it_is_the_optimum_of_the_printed_cost(seed):
    p = drawn(np.random.default_rng(seed))
    found = solve_ssp(p, WEIGHTS)
    assert found.residual < 1e-12
    place, tau = by_daqp(p)
    least = printed_cost(p, found.place, math.exp(p.omega * found.time))
    assert least <= printed_cost(p, place, tau) * (1.0 + 1e-7) + 1e-12
    assert found.place == pytest.approx(place, abs=1e-5)
    assert found.time == pytest.approx(math.log(tau) / p.omega, abs=1e-5)
    assert bounds_of(p)[0] - 1e-12 <= found.time <= bounds_of(p)[1] + 1e-12


@pytest.mark.parametrize("seed", range(10))
def test_the_papers_solver_finds_no_less(seed):
    p = drawn(np.random.default_rng(seed), polygon=False)
    found = solve_ssp(p, WEIGHTS)
    low, high = (math.exp(p.omega * t) for t in bounds_of(p))
    corners = np.asarray(p.region)
    box = [*zip(corners.min(axis=0), corners.max(axis=0), strict=True), (low / high, 1.0)]
    start = [*np.clip(p.target[:2], *zip(*box[:2], strict=True)), 1.0]
    theirs = minimize(lambda z: printed_cost(p, z[:2], z[2] * high), start, method="L-BFGS-B", bounds=box)
    assert printed_cost(p, found.place, math.exp(p.omega * found.time)) <= theirs.fun + 1e-12


@pytest.mark.parametrize("seed", range(20))
def test_what_it_says_it_misses_is_missed(seed):
    p = drawn(np.random.default_rng(seed))
    found = solve_ssp(p, WEIGHTS)
    wanted = target_dcms(found.place, p.stance, p.next_stride, p.next_duration, p.double_support, p.offset, p.omega)
    reached = dcm_at(p, found.time)
    assert found.missed == pytest.approx(reached - wanted.single_end, abs=1e-9)


def test_a_push_outward_moves_the_step_outward_and_ends_it_sooner():
    calm, pushed = (solve_ssp(problem(dcm=[0.0, y]), WEIGHTS) for y in (0.05, 0.08))
    assert pushed.place[1] > calm.place[1]
    assert pushed.time < calm.time


def test_confidence_keeps_the_nominal_footstep():
    away = {"dcm": [0.0, 0.075], "target": (0.1, 0.25, 0.6)}
    sure, unsure = (solve_ssp(problem(confidence=c, **away), WEIGHTS) for c in (1.0, 0.0))
    assert abs(sure.place[0]) < abs(unsure.place[0])
    assert unsure.place[0] > 0.01


def test_bounds_are_told():
    late = solve_ssp(problem(dcm=[0.0, 0.4]), WEIGHTS)
    early = solve_ssp(problem(dcm=[0.0, 0.0305], longest=0.5), WEIGHTS)
    assert (late.at_bound, late.time, late.at_edge) == (-1, pytest.approx(0.4), True)
    assert (early.at_bound, early.time) == (1, pytest.approx(0.5))


@pytest.mark.parametrize("region", [[[0.1, 0.2]], [[0.0, 0.2], [0.1, 0.3]], [[0.0, 0.2], [0.0, 0.2]]])
def test_a_region_may_be_a_line_or_a_point(region):
    found = solve_ssp(problem(region=region), WEIGHTS)
    assert found.residual < 1e-12
    assert found.at_edge
    along, off = np.subtract(region[-1], region[0]), found.place - region[0]
    assert abs(along[0] * off[1] - along[1] * off[0]) < 1e-15
    assert -1e-12 <= along @ off <= along @ along + 1e-12


def test_an_empty_region_has_no_footstep():
    assert solve_ssp(problem(region=np.empty((0, 2))), WEIGHTS) is None


@pytest.mark.parametrize("longest", [0.4, 20.0, 100.0])
@pytest.mark.parametrize("dcm", [[0.0, 0.03], [1e-12, 0.03], [50.0, -80.0]])
@pytest.mark.parametrize("omega", [2.5, 10.0])
def test_nothing_overflows(longest, dcm, omega):
    """80 m is where a second of 10 kN has the DCM of a body of 40 kg."""
    for elapsed in (0.0, longest):
        p = problem(omega=omega, dcm=dcm, longest=longest, offset=[80.0, -80.0], elapsed=elapsed, next_duration=100.0)
        found = solve_ssp(p, WEIGHTS)
        assert np.isfinite([*found.place, found.time, *found.missed, found.residual]).all()
        assert found.residual < 1e-8


def test_the_region_lies_beside_the_stance_foot():
    rules = StepRegionRules(forward=0.2, backward=0.1, clearance=0.01, outside=0.27)
    left = footstep_region(rules, "left", (1.0, 2.0, 0.0), 0.14)
    right = footstep_region(rules, "right", (1.0, 2.0, math.pi), 0.14)
    # Turned by half a turn, the right foot's place is where the left one's was, forward and backward exchanged.
    assert np.ptp(left, axis=0) == pytest.approx(np.ptp(right, axis=0))
    assert left.min(axis=0) == pytest.approx([0.9, 2.15])
    assert right.min(axis=0) == pytest.approx([0.8, 2.15])
    cut = footstep_region(rules, "left", (1.0, 2.0, 0.0), 0.14, ((1.0, 0.0, 1.05),))
    assert cut.max(axis=0) == pytest.approx([1.05, 2.27])


def test_wrong_arguments_are_named():
    with pytest.raises(InputError, match="DCM"):
        solve_ssp(problem(dcm=[math.nan, 0.0]), WEIGHTS)
    with pytest.raises(InputError, match="region"):
        solve_ssp(problem(region=[0.0, 1.0]), WEIGHTS)
    with pytest.raises(InputError, match=r"shortest single support is 2.0 s"):
        solve_ssp(problem(shortest=2.0), WEIGHTS)
    with pytest.raises(InputError, match="pendulum frequency"):
        solve_ssp(problem(omega=0.0), WEIGHTS)
