"""Walks over stones and mixed courses: `python benchmarks/outcomes.py MINUTES stones`.

Each ablation changes one thing, on the first ten of the seeds.
"""

from resumable import Benchmark, Case, shown

SEEDS, FEW = 60, 10
ROBOTS = ("h1", "hrp2kai")
VARIANTS: dict[str, tuple[str, ...]] = {
    "as it is": (),
    "steps keep their times": ("control.step_timing=false",),
    "footholds not looked at": ("footholds=off",),
}
BENCHMARK = Benchmark(
    "stones",
    {
        "steps_taken": "steps_taken",
        "tilt_max_deg": "tilt_max_deg",
        "replans": "replans",
        "at_torque_limit": "torque_limit.share_of_time",
        "foothold_error_p95_m": "footholds.centroid_error_m.p95",
    },
    [
        Case(name, "stones", robot, settings, FEW if settings else SEEDS, bool(settings))
        for name, settings in VARIANTS.items()
        for robot in ROBOTS
    ]
    + [Case("mixed course", "mixed", robot, (), 20) for robot in ROBOTS],
    {
        "time with a joint at its torque limit, median and most [%]": shown(
            "at_torque_limit", "{median:.1f}, {most:.1f}", 100.0, completed=True
        ),
        "centroid error, 95 % of a run [mm]": shown("foothold_error_p95_m", "{median:.1f}", 1e3, completed=True),
    },
)
