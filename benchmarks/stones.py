"""Walks over stones and mixed courses: `python benchmarks/outcomes.py MINUTES stones`."""

from resumable import Benchmark, Case, shown

ROBOTS = ("h1", "hrp2kai")
SEEDS = 4

BENCHMARK = Benchmark(
    "stones",
    {
        "steps_taken": "steps_taken",
        "tilt_max_deg": "tilt_max_deg",
        "replans": "replans",
        "at_torque_limit": "torque_limit.share_of_time",
        "foothold_error_p95_m": "footholds.centroid_error_m.p95",
    },
    [Case(scene, scene, robot, (), SEEDS, plants=("drawn",)) for scene in ("stones", "mixed") for robot in ROBOTS],
    {
        "time with a joint at its torque limit, median and most [%]": shown(
            "at_torque_limit", "{median:.1f}, {most:.1f}", 100.0, completed=True
        ),
        "centroid error, 95 % of a run [mm]": shown("foothold_error_p95_m", "{median:.1f}", 1e3, completed=True),
    },
)
