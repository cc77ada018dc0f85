"""Every walking scene on both robots: `python benchmarks/outcomes.py MINUTES walks`."""

from resumable import Benchmark, Case, failed, fallen, shown
from true_ground import RUNS

SEEDS, LONG = 20, 2

BENCHMARK = Benchmark(
    "walks",
    {
        "fell": "fell",
        "steps_taken": "steps_taken",
        "tilt_max_deg": "tilt_max_deg",
        "stance_force_rms": "stance_force_rms",
        "zmp_edge_share": "zmp_edge_share",
        "impact_max": lambda simulation, out: round(max(out["impacts_N"] or [0.0]) / simulation.body.weight, 3),
        "at_torque_limit": "torque_limit.share_of_time",
    },
    [
        Case(scene, scene, robot, (), LONG if scene == "long-walk" else SEEDS, plants=("ordinary", "exact"))
        for scene, robot in RUNS
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
