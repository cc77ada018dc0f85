"""How fast robots walk ten metres of level ground, and whether they walk a hundred at their own pace.

`python benchmarks/outcomes.py MINUTES speed` runs what is missing and writes the table. G1 and T1 are what
`benchmarks/public_robots.py` made of their models. Two paces have twenty seeds.
"""

import math
from itertools import product

import numpy as np
from public_robots import MADE
from resumable import Benchmark, Case, failed, shown

FILES = {name: str(MADE / name / "robot.toml") for name in ("Unitree G1", "Booster T1")}
LEGS = {"h1": 0.6, "hrp2kai": 0.6, "Unitree G1": 0.637, "Booster T1": 0.516}

# length of a step in legs, single and double support in beats
PACES = [
    *((1 / 3, 3.03, 0.8), (0.4, 3.03, 0.6), (0.4, 2.42, 0.5), (0.3, 2.02, 0.4)),
    *((0.4, 2.02, 0.4), (0.45, 2.02, 0.4), (0.5, 2.42, 0.5), (0.5, 2.02, 0.4)),
]
OFTEN = ((0.4, 2.42, 0.5), (0.45, 2.02, 0.4))
"""Paces of 20 seeds: what all four walk, and 0.18 of sqrt(g leg)."""


def ten_metres(robot: str, length: float, single: float, double: float) -> Case:
    settings = (
        f"steps={math.ceil(10.0 / (length * LEGS[robot]))}",
        f'length="{length:.4g} leg"',
        f'single_support="{single} beat"',
        f'double_support="{double} beat"',
        "approach_height=0",  # a robot that could approach slowly takes its time for that
    )
    seeds = 20 if (length, single, double) in OFTEN else 2
    name = f"10 m, {length / (single + double):.3f} sqrt(g leg), steps of {length:.2g} legs"
    return Case(name, "flat", robot, settings, seeds, file=FILES.get(robot, ""))


def hundred_metres(robot: str) -> Case:
    steps, file = f"steps={math.ceil(100.0 / (LEGS[robot] / 3.0)) + 1}", FILES.get(robot, "")
    return Case("100 m, own pace", "long-walk", robot, (steps,), 1, file=file, aside=True)


BENCHMARK = Benchmark(
    "speed",
    {
        "speed": lambda simulation, out: round(_speed(simulation, out), 4),
        "impact_median": lambda simulation, out: _impact(simulation, out, 0.5),
        "impact_max": lambda simulation, out: _impact(simulation, out, 1.0),
        "torque_limit": "torque_limit.share_of_time",
        "steps": "steps_taken",
        "height_error_mm": lambda simulation, out: round(1e3 * float(out["estimate"]["com_error_max_m"][2]), 2),
    },
    [*(ten_metres(robot, *pace) for pace, robot in product(PACES, LEGS)), *map(hundred_metres, LEGS)],
    {
        "speed [m/s]": shown("speed", "{median:.2f}"),
        "steps": shown("steps", "{median:.0f}"),
        "impact, median [BW]": shown("impact_median", "{median:.2f}"),
        "impact, largest [BW]": shown("impact_max", "{median:.2f}"),
        "ticks with a torque at its limit [%]": shown("torque_limit", "{median:.1f}", 100.0),
        "largest error of CoM height [mm]": shown("height_error_mm", "{median:.1f}"),
        "failed": failed,
    },
)


def _speed(simulation, out) -> float:
    """Mean speed in m/s from the second landing to the last."""
    times = out["landings_s"]
    return (len(times) - 2) * simulation.scene.walk.length / (times[-1] - times[1]) if len(times) > 2 else 0.0


def _impact(simulation, out, share: float) -> float:
    """Quantile of the landings' impacts in body weights."""
    return round(float(np.quantile(out["impacts_N"] or [0.0], share)) / simulation.body.weight, 3)
