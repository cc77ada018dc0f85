"""Walks at commanded velocities, drawn every 6 s for 60 s: `python benchmarks/outcomes.py MINUTES velocity`."""

from resumable import Benchmark, Case, shown

SPREAD = "{median:.3f} ({least:.3f} to {most:.3f})"
BENCHMARK = Benchmark(
    "velocity",
    {
        "speed_ratio": "velocity.speed_ratio",
        "turn_ratio": "velocity.turn_ratio",
        "walked_m": "velocity.walked_m",
        "turned_deg": "velocity.turned_deg",
        "steps": lambda simulation, out: len(out["landings_s"]),
        "steps_after_stop": "velocity.steps_after_stop",
        "tilt_deg": "tilt_max_deg",
        "wall_s": "wall_time_s",
    },
    [Case("wander", "wander", robot, (), 20) for robot in ("h1", "hrp2kai")],
    {
        "speed / command": shown("speed_ratio", SPREAD),
        "turn / command": shown("turn_ratio", SPREAD),
        "steps after the stop": shown("steps_after_stop", "at most {most:.0f}"),
        "tilt [deg]": shown("tilt_deg", "at most {most:.2f}"),
    },
)
