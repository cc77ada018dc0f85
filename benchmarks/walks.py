"""Every walking scene on both robots: `python benchmarks/outcomes.py MINUTES walks`."""

from itertools import product

from resumable import Benchmark, Case, failed, fallen, largest_impact, shown
from true_ground import RUNS

SEEDS, LONG, WORN = 20, 2, 10
WORN_RUNS = tuple(product(("flat", "push", "beam", "turn", "stones"), ("h1", "hrp2kai")))
"""Counted with wear and poor ground, too."""

BENCHMARK = Benchmark(
    "walks",
    {
        "fell": "fell",
        "steps_taken": "steps_taken",
        "tilt_max_deg": "tilt_max_deg",
        "stance_force_rms": "stance_force_rms",
        "zmp_edge_share": "zmp_edge_share",
        "impact_max": largest_impact,
        "at_torque_limit": "torque_limit.share_of_time",
    },
    [
        Case(scene, scene, robot, (), LONG if scene == "long-walk" else SEEDS, plants=("ordinary", "exact"))
        for scene, robot in RUNS
    ]
    + [
        Case(f"{scene}, worn", scene, robot, ("plant=everything",), WORN, plants=("own",)) for scene, robot in WORN_RUNS
    ],
    {
        "falls": fallen,
        "failed": failed,
        "force's ripple [% of weight]": shown("stance_force_rms", "{median:.2f}", 100.0),
        "ZMP at an edge [%]": shown("zmp_edge_share", "{median:.2f}", 100.0),
        "largest impact [BW]": shown("impact_max", "{median:.2f}"),
        "a torque at its limit [%]": shown("at_torque_limit", "{median:.1f}", 100.0),
    },
    "Medians on drawn plants.",
)
