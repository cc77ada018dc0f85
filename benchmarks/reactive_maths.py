"""The closed forms and optima of force-reactive walking: run time, KKT residuals, the paper's solver.

python benchmarks/reactive_maths.py        (writes benchmarks/reactive_maths.md)
"""

import math
import time
from pathlib import Path

import numpy as np
from capture_limit import CaptureLimits
from periodic_walk import PeriodicWalk, capture_map
from scipy.integrate import solve_ivp
from scipy.optimize import minimize

from plantar.bench.tables import markdown_table
from plantar.common.atomic import write_text
from plantar.common.sides import SIDES
from plantar.gait.balance.ankle_strategy import (
    AnkleRules,
    double_support_pull,
    double_support_vrp,
    single_support_vrp,
    target_dcms,
    within_support,
)
from plantar.gait.estimate.dcm_filter import DcmFilter, DcmFilterRules
from plantar.gait.estimate.wrench_filter import WrenchFilter, WrenchFilterRules
from plantar.gait.feet.swing_fit import SwingFit, SwingFitRules
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import Timing
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.propose.dsp_opt import DspProblem, DspWeights, solve_dsp
from plantar.gait.propose.proposer import Pendulum, Tick
from plantar.gait.propose.ssp_opt import SspProblem, StepRegionRules, StepWeights, footstep_region, solve_ssp
from plantar.gait.propose.step_adjustment import StepAdjustment, StepAdjustmentRules
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.mechanics.external_wrench import vrp_offset
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.net_wrench import NetWrenchRules, net_wrench
from plantar.sensing.reading import Reading

OMEGA, MASS, PERIOD = 3.44, 86.0, 0.005
COUNT = 2000
SOLE = np.array([[-0.09, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.09, 0.05]])
WEIGHTS, DSP_WEIGHTS = StepWeights(), DspWeights()


def timed(function, cases) -> np.ndarray:
    """Least of three times (n,) of each call in us."""
    out = []
    for case in cases:
        best = math.inf
        for _ in range(3):
            begin = time.perf_counter_ns()
            function(case)
            best = min(best, time.perf_counter_ns() - begin)
        out.append(1e-3 * best)
    return np.array(out)


def single_supports(rng, count) -> list[SspProblem]:
    """A robot that steps in place under random pushes, up to 60 N s, in a single support."""
    rules = StepRegionRules(forward=0.2, backward=0.2, clearance=0.01, outside=0.27)
    found = []
    for _ in range(count):
        elapsed, angle = rng.uniform(0.0, 0.7), rng.uniform(0.0, 2.0 * math.pi)
        push = rng.uniform(0.0, 60.0) / (MASS * OMEGA) * np.array([math.cos(angle), math.sin(angle)])
        dcm = np.array([0.0, 0.02 + 0.02 * math.exp(OMEGA * (elapsed - 0.4))]) + push
        target = target_dcms([0.0, 0.2], [0.0, 0.0], [0.0, -0.2], 0.8, 0.1, [0.0, 0.0], OMEGA).single_end
        offset = 0.1 * rng.uniform() * push
        vrp = within_support(single_support_vrp(dcm, target, 0.8 - elapsed, offset, OMEGA), SOLE).vrp
        shortest = max(0.4, elapsed + 0.1)
        found.append(
            SspProblem(
                omega=OMEGA,
                dcm=dcm,
                vrp=vrp,
                offset=offset,
                stance=np.zeros(2),
                elapsed=elapsed,
                target=(*rng.normal([0.0, 0.2], 0.02), 0.8),
                nominal=(0.0, 0.2, 0.8),
                region=footstep_region(rules, "left", (0.0, 0.0, 0.0), 0.14),
                shortest=shortest,
                longest=1.7,
                next_stride=np.array([0.0, -0.2]),
                next_duration=0.8,
                double_support=0.1,
                confidence=rng.uniform(),
            )
        )
    return found


def double_supports(rng, count) -> list[DspProblem]:
    """A robot that shifts its weight by 0.2 m to the side under random pushes, up to 60 N s."""
    end, goal, found = np.array([0.0, 0.2]), None, []
    for _ in range(count):
        begun, angle = rng.uniform(0.0, 0.15), rng.uniform(0.0, 2.0 * math.pi)
        push = rng.uniform(0.0, 60.0) / (MASS * OMEGA) * np.array([math.cos(angle), math.sin(angle)])
        targets = target_dcms(end, [0.0, 0.0], [0.0, -0.2], 0.8, 0.2, [0.0, 0.0], OMEGA)
        goal = targets.double_end
        rate = 0.5 * math.pi / 0.2
        calm = solve_ivp(
            lambda t, x, w=rate: OMEGA * (x - end * math.sin(w * t)), (0.0, begun), targets.single_end, rtol=1e-9
        ).y[:, -1]
        vrp = double_support_vrp(calm + push, goal, end, 0.2, begun, [0, 0], OMEGA).vrp
        vrp = np.clip(vrp, [-0.09, -0.05], [0.14, 0.25])
        found.append(
            DspProblem(OMEGA, calm + push, goal, vrp, end, np.zeros(2), begun, rng.uniform(0.15, 0.4), 0.2, 0.5)
        )
    return found


def ssp_cost(p: SspProblem):
    """K 28-31 in (u, tau) with its gradient, as the paper hands it to L-BFGS-B, and its bounds."""
    at = [
        target_dcms(u, p.stance, p.next_stride, p.next_duration, p.double_support, p.offset, OMEGA).single_end
        for u in ([0.0, 0.0], [1.0, 0.0])
    ]
    slope, now = at[1][0] - at[0][0], p.vrp - p.offset
    grown = (p.dcm - now) * math.exp(-OMEGA * p.elapsed)
    low, high = (math.exp(OMEGA * t) for t in (p.shortest, p.longest))
    w_u, w_tau, c = 1.0 / np.ptp(p.region, axis=0), 1.0 / (high - low), p.confidence
    kept = [(share, np.array(f[:2]), math.exp(OMEGA * f[2])) for share, f in ((c, p.nominal), (1.0 - c, p.target))]

    def cost(z):
        u, tau = z[:2], z[2]
        r = slope * u + at[0] - now - grown * tau
        total = 0.5 * WEIGHTS.dynamics * (r @ r)
        by_u, by_tau = WEIGHTS.dynamics * slope * r, -WEIGHTS.dynamics * (r @ grown)
        for share, place, at_tau in kept:
            off, late = u - place, tau - at_tau
            total += share * 0.5 * (w_u @ (off * off) + w_tau * late * late)
            by_u, by_tau = by_u + share * w_u * off, by_tau + share * w_tau * late
        return total, np.array([by_u[0], by_u[1], by_tau])

    corners = p.region.min(axis=0), p.region.max(axis=0)
    return cost, [*zip(*corners, strict=True), (low, high)]


def dsp_cost(p: DspProblem):
    """K 34-37 with finite differences, and its bounds."""

    def cost(z):
        t, left = float(z[0]), float(z[0]) - p.elapsed
        pull = double_support_pull(OMEGA, t, left)
        end = p.end - p.offset
        missed = end + math.exp(OMEGA * left) * (p.dcm - end + (p.end - p.vrp) * pull) - p.goal
        total = 0.5 * DSP_WEIGHTS.dynamics * float(missed @ missed)
        for share, kept in ((p.confidence, p.nominal), (1.0 - p.confidence, p.target)):
            total += share * 0.5 * (1.0 if t >= kept else 5.0) * (t - kept) ** 2
        return total

    return cost, [(max(0.5 * p.nominal, p.elapsed + 1e-6), 5.0 * p.nominal)]


def compared_with_lbfgs(problems, solve, cost_of, start_of, place_of, gradient):
    """Rows of the table: ours and L-BFGS-B, with time and cost over the least found."""
    prepared = [(cost_of(p), start_of(p)) for p in problems]
    ours = [solve(p) for p in problems]

    def theirs(case):
        (cost, bounds), start = case
        start = np.clip(start, *np.transpose(bounds))
        return minimize(cost, start, jac=gradient, method="L-BFGS-B", bounds=bounds)

    def value(cost, z):
        return cost(z)[0] if gradient else cost(z)

    found = [theirs(case).x for case in prepared]
    own = np.array([value(c, place_of(f)) for ((c, _), _), f in zip(prepared, ours, strict=True)])
    other = np.array([value(c, z) for ((c, _), _), z in zip(prepared, found, strict=True)])
    least = np.minimum(own, other)
    yield timed(solve, problems), own / least - 1.0, max(f.residual for f in ours)
    yield timed(theirs, prepared), other / least - 1.0, None


def pushed_ticks(rng, count, most) -> list[Tick]:
    """A robot that steps in place and whose DCM is moved by up to some m in the middle of a step."""
    feet, steps = straight_plan(8, length=0.0)
    plan = WalkPlan(feet, steps, Timing(), dict.fromkeys(SIDES, np.zeros(2)), OMEGA, 1.0)
    phase = next(p for p in plan.schedule.phases if p.swing and p.step == 3)
    frame, found = CommandFrame(np.zeros(3), PERIOD, 0.3), []
    for _ in range(count):
        now, angle = phase.start + rng.uniform(0.2, 0.6) * (phase.end - phase.start), rng.uniform(0.0, 2.0 * math.pi)
        reference, off = plan.at(now), rng.uniform(0.0, most) * np.array([math.cos(angle), math.sin(angle)])
        region = reference.vrp + SOLE
        pendulum = Pendulum(OMEGA, reference.dcm + off, reference, plan.dcm_after(phase), region)
        places = {side: (feet[side].position, 0.0) for side in SIDES}
        places[phase.swing] = (feet[phase.swing].position + np.array([0.0, 0.0, 0.05]), 0.0)
        view = FeetView(places, phase.swing, landed=False)
        found.append(Tick(now, phase, plan.view, view, frame, pendulum=pendulum))
    return found


def layer(rng):
    """Name, function and cases of each part of a tick."""
    pushes = rng.normal(size=(COUNT, 6)) * [50, 50, 5, 10, 10, 2]
    places = rng.normal(size=(COUNT, 2)) * 0.05
    none = np.zeros(2)
    taxels = 300
    skin = BodySkin(
        [
            SkinPatch(n, n, rng.normal(size=(taxels, 3)), np.tile(np.eye(3), (taxels, 1, 1)), np.full(taxels, 1e-3))
            for n in ("torso", "arm")
        ]
    )
    poses = {link: (np.zeros(3), np.eye(3)) for link in skin.links}
    still = Reading(0.0, np.zeros(2 * taxels), np.full(2 * taxels, np.inf))
    force = np.where(np.arange(2 * taxels) % 30 == 0, 3.0, 0.0)
    pushed = Reading(0.0, force, np.full(2 * taxels, np.inf))
    rules, about = NetWrenchRules(), np.zeros(3)
    yield "net wrench, 600 taxels, none active", lambda _: net_wrench(skin, still, poses, about, rules), range(COUNT)
    yield "net wrench, 600 taxels, 20 active", lambda _: net_wrench(skin, pushed, poses, about, rules), range(COUNT)
    yield "VRP offset of a wrench (K 9-11)", lambda w: vrp_offset(w, MASS, OMEGA), pushes
    follow = WrenchFilter(WrenchFilterRules(), OMEGA, PERIOD)
    yield "expected push, update and mean (K 18-19)", lambda u: (follow.update(u), follow.mean(0.4)), places
    kalman = DcmFilter(DcmFilterRules(), OMEGA, PERIOD)
    yield "CoM and DCM, update", lambda x: kalman.update(x, None, x, none), places
    goal = np.array([0.05, 0.0])
    yield (
        "ankle strategy, single support (K 25, 27)",
        lambda x: within_support(single_support_vrp(x, goal, 0.4, none, OMEGA), SOLE),
        places,
    )
    yield (
        "ankle strategy, double support (K 25-27)",
        lambda x: within_support(double_support_vrp(x, goal, none, 0.2, 0.1, none, OMEGA), SOLE),
        places,
    )
    fit = SwingFit(SwingFitRules(), np.zeros(3), PERIOD, 0.05)
    goals = np.column_stack([places, np.zeros(COUNT)])
    yield "swing fit, goal and time new at each call (K 13-16)", lambda g: fit.aim(g, 0.3, 0.7 + g[0]), goals
    seen = np.zeros(3)
    yield "swing fit, with the measured foot", lambda g: fit.aim(g, 0.3, 0.7 + g[0], seen), goals
    made = StepAdjustmentRules(pause=0.0), StepRegionRules(), 0.14, WEIGHTS, AnkleRules(), PERIOD
    for name, most in (("while the ZMP does", 0.001), ("searched (K 4.2)", 0.12)):
        # One for each tick: it does not go back in time.
        ticks = [(StepAdjustment(*made), tick) for tick in pushed_ticks(rng, COUNT, most)]
        moved = [(steps, tick) for steps, tick in ticks if (steps.propose(tick) is not None) == (most > 0.1)]
        yield f"step adjustment, {name}", lambda case: case[0].propose(case[1]), moved


def closed_form_errors(rng, count=200) -> tuple[float, float]:
    """Largest distance in m by which an integrated DCM misses the goal of the VRPs in single and double support."""
    single = double = 0.0
    for _ in range(count):
        dcm, goal, end, offset = rng.uniform(-0.3, 0.3, (4, 2))
        omega, lasts = rng.uniform(2.5, 8.0), rng.uniform(0.05, 0.8)

        def missed(vrp, dcm=dcm, goal=goal, offset=offset, omega=omega, lasts=lasts):
            found = solve_ivp(
                lambda t, x: omega * (x - vrp(t) + offset), (0.0, lasts), dcm, "DOP853", rtol=1e-13, atol=1e-15
            )
            return float(np.abs(found.y[:, -1] - goal).max())

        kept = single_support_vrp(dcm, goal, lasts, offset, omega).vrp
        single = max(single, missed(lambda _, p=kept: p))
        begins = double_support_vrp(dcm, goal, end, lasts, 0.0, offset, omega).vrp
        double = max(
            double,
            missed(lambda t, a=begins, b=end, n=lasts: b - (b - a) * (1.0 - math.sin(0.5 * math.pi * t / n))),
        )
    return single, double


def capture_times():
    region = np.array([[-0.2, 0.15], [0.25, 0.15], [0.25, 0.33], [-0.2, 0.33]])
    for steps, times in ((1, 8), (2, 8), (3, 5)):
        limits = CaptureLimits(
            MASS, OMEGA, SOLE, region, 0.5, 1.2, 0.2, swing_acceleration=8.0, steps=steps, times=times
        )
        begin, cells = time.perf_counter(), []
        for length in (0.0, 0.18):  # in place, and at 0.2 m/s
            cells.append(capture_map(limits, PeriodicWalk(OMEGA, length, 0.2, 0.7, 0.2)))
        yield steps, times, time.perf_counter() - begin, np.array(cells)


def main() -> None:
    rng = np.random.default_rng(0)
    lines = [
        "# Force-reactive walking: run time, residuals, and the paper's solver",
        "",
        "Equations of K (docs/references.md). Times are the least of three calls a case, 2,000 cases, on one core of a",
        "2-core x86-64. Written by `python benchmarks/reactive_maths.py`.",
        "",
    ]
    parts = []
    total = searched = 0.0
    for name, function, cases in layer(rng):
        times = timed(function, cases)
        parts.append((name, f"{np.median(times):.1f}", f"{np.percentile(times, 99):.1f}"))
        if "step adjustment" in name:
            searched = float(np.median(times))
        elif not any(w in name for w in ("none active", "double", "new at each")):
            total += float(np.median(times))
    singles, doubles = single_supports(rng, COUNT), double_supports(rng, COUNT)
    few = COUNT // 4
    tables = [
        (
            "SSP-Opt (K 31-33)",
            compared_with_lbfgs(
                singles[:few],
                lambda p: solve_ssp(p, WEIGHTS),
                ssp_cost,
                lambda p: [*p.target[:2], math.exp(OMEGA * p.target[2])],
                lambda f: np.array([*f.place, math.exp(OMEGA * f.time)]),
                True,
            ),
        ),
        (
            "DSP-Opt (K 37-38)",
            compared_with_lbfgs(
                doubles[:few],
                lambda p: solve_dsp(p, DSP_WEIGHTS),
                dsp_cost,
                lambda p: [p.target],
                lambda f: [f.time],
                None,
            ),
        ),
    ]
    solved, solves = [], 0.0
    for name, rows in tables:
        for who, (times, excess, residual) in zip(("here", "scipy's L-BFGS-B"), rows, strict=True):
            worse = float(np.mean(excess > 1e-6))
            shown = None if residual is None else f"{residual:.0e}"
            taken = (f"{np.median(times):.1f}", f"{np.percentile(times, 99):.1f}")
            solved.append((name, who, *taken, f"{100 * worse:.1f} %", f"{excess.max():.1e}", shown))
            solves = float(np.median(times)) if who == "here" and name.startswith("SSP") else solves
    lines += [
        markdown_table(("part of a tick", "median [us]", "99 % [us]"), parts),
        "",
        f"The whole layer in a single support under a push, with skin: {total + searched:.0f} us where the footstep is",
        f"searched for, {total + solves:.0f} us with SSP-Opt's solution in the search's place.",
        "",
        f"Optima of {few} pushes up to 60 N s, from all sides, at any time. Worse: cases in which a cost is more",
        "than 1e-6 above the least that either found; excess: by what share at most. Residual: of the KKT conditions,",
        "over the gradient's largest term. L-BFGS-B starts from the tick before, with its usual tolerances; for",
        "SSP-Opt it gets the exact gradient.",
        "",
        markdown_table(("optimum", "by", "median [us]", "99 % [us]", "worse", "excess", "residual"), solved),
    ]
    single, double = closed_form_errors(rng)
    lines += [
        "",
        f"Closed forms compared with integration (DOP853, 1e-13), 200 cases: {single:.0e} in single support, "
        f"{double:.0e} in double support, of the larger of 1 m and the DCM.",
        "",
        "Capture maps, 8 directions and 8 phases, in place and at 0.2 m/s (128 cells), of a robot of 86 kg whose swing",
        "foot is accelerated by 8 m/s^2:",
        "",
    ]
    maps = [
        (steps, times, *(f"{value:.1f}" for value in (taken, cells.min(), cells.mean(), cells.max())))
        for steps, times, taken, cells in capture_times()
    ]
    head = ("steps", "durations tried", "time [s]", "least [N s]", "mean [N s]", "most [N s]")
    lines.append(markdown_table(head, maps))
    print(write_text(Path(__file__).with_suffix(".md"), "\n".join(lines) + "\n").read_text())


if __name__ == "__main__":
    main()
