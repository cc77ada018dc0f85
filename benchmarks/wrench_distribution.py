"""Run time of the wrench-distribution program compared with other ways to solve it.

python benchmarks/wrench_distribution.py        (writes benchmarks/wrench_distribution.md)
"""

import itertools
import math
import time
from pathlib import Path

import daqp
import numpy as np
import qpsolvers
import quadprog
from scipy.optimize import minimize

from plantar.common.atomic import write_text
from plantar.mechanics.contact import Contact
from plantar.mechanics.wrench_cone import Rectangle
from plantar.mechanics.wrench_distribution import WrenchDistribution

WEIGHT = 640.0
SOLE = Rectangle(-0.114, 0.144, -0.080, 0.080)


def heading(yaw):
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def requests(rng, count, *, moving):
    """Requests as a control loop makes them: a ZMP that wanders through double support, with noise."""
    out = []
    for k in range(count):
        turn = heading(rng.uniform(-3.0, 3.0)) if moving else np.eye(3)
        place = rng.uniform(-5.0, 5.0, 3) if moving else np.zeros(3)
        sole = Rectangle(*(np.array(SOLE) * rng.uniform(0.4, 1.0))) if moving else SOLE
        places = {"left": (0.2, 0.105), "right": (0.0, -0.105)}
        feet = {side: Contact(place + turn @ [x, y, 0.0], turn, sole) for side, (x, y) in places.items()}
        share = 0.5 - 0.5 * math.cos(2.0 * math.pi * k / 100.0)
        zmp = np.array([0.2 * share, 0.21 * share - 0.105, 0.0]) + rng.normal(0.0, 0.01, 3) * [1, 1, 0]
        com = np.array([0.1, 0.0, 0.87])
        force = WEIGHT * np.array([*rng.normal(0.0, 0.03, 2), rng.uniform(0.95, 1.05)])
        moment = np.cross(zmp - com, force)
        out.append(
            (
                feet,
                np.concatenate([turn @ force, turn @ moment]),
                place + turn @ com,
                {"left": share, "right": 1.0 - share},
            )
        )
    return out


def timed(function, cases):
    out = []
    for case in cases:
        begin = time.perf_counter_ns()
        function(case)
        out.append(1e-3 * (time.perf_counter_ns() - begin))
    return out


def alternatives(programs):
    """Name, function on a case, cases."""

    def slsqp(p):
        constraint = {"type": "ineq", "fun": lambda v: p.upper - p.constraints @ v, "jac": lambda v: -p.constraints}
        return minimize(
            lambda v: 0.5 * v @ p.hessian @ v + p.gradient @ v,
            np.zeros(len(p.gradient)),
            jac=lambda v: p.hessian @ v + p.gradient,
            constraints=[constraint],
            method="SLSQP",
        ).x

    lower = np.full(len(programs[0].upper), -1e30)
    yield (
        "`daqp.solve` on ready matrices, set up at each call",
        lambda p: daqp.solve(p.hessian, p.gradient, p.constraints, p.upper, lower)[0],
        programs,
    )
    yield (
        "`quadprog.solve_qp` on ready matrices",
        lambda p: quadprog.solve_qp(p.hessian, -p.gradient, -p.constraints.T, -p.upper)[0],
        programs,
    )
    yield (
        "`qpsolvers` with daqp on ready matrices",
        lambda p: qpsolvers.solve_qp(p.hessian, p.gradient, p.constraints, p.upper, solver="daqp"),
        programs,
    )
    yield "scipy `minimize` (SLSQP) on ready matrices", slsqp, programs[:100]


def main() -> None:
    rng = np.random.default_rng(0)
    loop, moving = requests(rng, 4000, moving=False), requests(rng, 4000, moving=True)
    ours = WrenchDistribution(WEIGHT)
    programs = [ours.program(*r) for r in loop[:2000]]
    exact = [quadprog.solve_qp(p.hessian, -p.gradient, -p.constraints.T, -p.upper)[0] * p.unit for p in programs]
    rows = [
        (
            "`WrenchDistribution.solve`, feet stand (a control loop)",
            lambda r: np.concatenate(list(ours.solve(*r).wrenches.values())),
            loop,
        ),
        ("`WrenchDistribution.solve`, feet and contacts new at each call", lambda r: ours.solve(*r).wrenches, moving),
        *alternatives(programs),
    ]
    lines = [
        "# Wrench distribution: run time",
        "",
        "Two feet, 12 unknowns, 34 constraints (16 facets of each foot's wrench cone and a least normal force), cost",
        "after Caron et al. 2019; a ZMP that wanders between the feet with noise. The first two rows take contacts and",
        "a wanted wrench and give foot wrenches; the others only solve a program that is set up already. Error:",
        "largest difference of a foot's wrench to quadprog's (N or N m).",
        "Written by `python benchmarks/wrench_distribution.py`.",
        "",
        "| method | median [us] | 99 % [us] | ratio | error |",
        "|---|---|---|---|---|",
    ]
    base = 0.0
    for name, function, cases in rows:
        timed(function, itertools.islice(cases, 50))
        times = timed(function, cases)
        t = float(np.median(times))
        base = base or t
        error = "-"
        if cases is not moving:
            unit = 1.0 if cases is loop else programs[0].unit
            found = [np.asarray(function(c)) * unit for c in cases[: len(exact)]]
            error = f"{max(float(np.abs(a - b).max()) for a, b in zip(found, exact, strict=False)):.0e}"
        lines.append(f"| {name} | {t:.1f} | {np.percentile(times, 99):.1f} | {t / base:.1f} | {error} |")
    print(write_text(Path(__file__).with_suffix(".md"), "\n".join(lines) + "\n").read_text())


if __name__ == "__main__":
    main()
