"""How far robots come on stairs, slopes, a height field and with a load: a ladder of each.

`python benchmarks/outcomes.py MINUTES grounds` runs what is missing and writes the table.
"""

from itertools import product

from resumable import Benchmark, Case, failed, fallen, largest_impact, shown

# name, scene, settings
LADDER: list[tuple[str, str, tuple[str, ...]]] = [
    *((f"stairs as planned, {v} leg", "stairs", (f'climb="{v} leg"',)) for v in (0.03, 0.05, 0.1, 0.15)),
    *((f"stairs not planned, {v} leg", "stairs", ("climb=0", f'rise="{v} leg"')) for v in (0.03, 0.05, 0.1)),
    *((f"slopes, {v} deg", "slopes", (f"slope={v}",)) for v in (3, 6, 10)),
    *((f"height field, {n}/60 leg", "height-field", (f'unevenness="{n}/60 leg"',)) for n in (4,)),
    *((f"load, {v}", "load", (f"load={v}",)) for v in (0.05, 0.1)),
]

BENCHMARK = Benchmark(
    "grounds",
    {
        "fell": lambda simulation, out: int(out["fell"]),
        "steps": "steps_taken",
        "planned": lambda simulation, out: len(simulation.steps),
        "impact_max": largest_impact,
        "tilt_deg": "tilt_max_deg",
        "time_s": "sim_time_s",
    },
    [Case(name, scene, robot, settings, 2) for (name, scene, settings), robot in product(LADDER, ("h1", "hrp2kai"))],
    {
        "steps": shown("steps", "{least:.0f}"),
        "of": shown("planned", "{most:.0f}"),
        "largest impact [BW]": shown("impact_max", "{most:.2f}"),
        "falls": fallen,
        "failed": failed,
    },
)
