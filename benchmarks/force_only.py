"""Walks by the forces of taxels alone: `python benchmarks/outcomes.py MINUTES force_only`.

No proximity (`footholds=force`), and taxels on an elastic layer, which the fit of edges does not know
(`sensing.taxels=elastic`). Ablations get the first four of the seeds.
"""

from resumable import FEW, Benchmark, Case, Row, shown

FORCE = ("footholds=force", "sensing.taxels=elastic")
ERRORS = ("plant.taxel_gain=0.15", "plant.crosstalk=0.1")
WALKS: dict[str, tuple[str, tuple[str, ...]]] = {
    "`partial-rear`": ("partial-rear", ()),
    "`beam` 12 cm, +-80 mm": ("beam", ("terrain.width=0.48 sole", "offset_range=0.32 sole")),
    "`beam` 8 cm, +-60 mm": ("beam", ("terrain.width=0.32 sole", "offset_range=0.24 sole")),
    "`beam` 6 cm, +-40 mm": ("beam", ("terrain.width=0.24 sole", "offset_range=0.16 sole")),
}
EVERY = tuple(WALKS)
BEAM, REAR = (EVERY[2],), (EVERY[0],)
# what differs, settings, whether for comparison only, walks
VARIANTS: list[tuple[str, tuple[str, ...], bool, tuple[str, ...]]] = [
    ("", FORCE, False, EVERY),
    (", taxel errors", (*FORCE, *ERRORS), False, EVERY),
    (", no memory", (*FORCE, "contact.remember=false"), True, BEAM),
    (", not probing", (*FORCE, "landing.probing=false"), True, BEAM),
    (", not levelled", (*FORCE, "landing.levelling=0"), True, REAR),
    (", on springs", ("footholds=force",), True, BEAM + REAR),
    (", on a half-space", (*FORCE, "sensing.layer=10"), True, BEAM + REAR),
]


def steps_of_failed(rows: list[Row]) -> str:
    """Steps of the runs that were not completed."""
    return ", ".join(sorted((r["steps_taken"] for r in rows if r["completed"] != "True"), key=int)) or "-"


BENCHMARK = Benchmark(
    "force_only",
    {
        **{name: name for name in ("steps_taken", "sim_time_s", "tilt_max_deg", "replans")},
        "foothold_error_median_m": "footholds.centroid_error_m.median",
        "foothold_error_p95_m": "footholds.centroid_error_m.p95",
    },
    [
        Case(f"{name}{what}", scene, robot, (*settings, *more), FEW if aside else 20, aside)
        for name, (scene, settings) in WALKS.items()
        for what, more, aside, walks in VARIANTS
        if name in walks
        for robot in ("h1", "hrp2kai")
    ],
    {
        "steps of failed runs": steps_of_failed,
        "centroid error, median of a run [mm]": shown("foothold_error_median_m", "{median:.1f}", 1e3),
    },
)
