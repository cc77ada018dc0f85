"""Every walking scene on both robots: `python benchmarks/outcomes.py MINUTES walks`."""

from resumable import Benchmark, Case, Row, failed, fallen, shown
from true_ground import RUNS

from plantar.sim.judging.run_limits import limit_reasons

SEEDS, LONG = 20, 2
UNEVEN = (
    "feasibility",
    "height-field",
    "mixed",
    "obstacle",
    "pebbles",
    "slide-in",
    "slopes",
    "stairs",
    "tilt",
    "uneven",
)
"""What the names of scenes on steps and slopes begin with: there landings may be harder."""


def beyond_limits(rows: list[Row]) -> str:
    """How many runs that count as completed have an impact or a time at a torque limit that no longer count."""

    def is_beyond(row: Row) -> bool:
        level = not row["case"].startswith(UNEVEN)
        return bool(limit_reasons([float(row["impact_max"] or 0.0)], level, float(row["at_torque_limit"] or 0.0)))

    return str(sum(row["completed"] == "True" and is_beyond(row) for row in rows))


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
        "completed, but beyond a limit": beyond_limits,
        "force's ripple [% of weight]": shown("stance_force_rms", "{median:.2f}", 100.0),
        "ZMP at an edge [%]": shown("zmp_edge_share", "{median:.2f}", 100.0),
        "largest impact [BW]": shown("impact_max", "{median:.2f}"),
        "a torque at its limit [%]": shown("at_torque_limit", "{median:.1f}", 100.0),
    },
    "Medians on drawn plants.",
)
