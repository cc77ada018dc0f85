"""What the soles' view of a foothold is worth: `python benchmarks/outcomes.py MINUTES footholds`."""

from statistics import median

from resumable import FOLDER, HEADS, Benchmark, Case, counted, latest, of_now, origin, rows_of, values, write_table

from plantar.bench.tables import markdown_table

ROBOTS = ("h1", "hrp2kai")
SEEDS = 2
LINES: list[tuple[str, str, tuple[str, ...]]] = [
    *((f"`partial-{part}`", f"partial-{part}", ()) for part in ("rear", "front", "third")),
    ("`beam` 12 cm, +-80 mm", "beam", ()),
    ("`beam` 8 cm, +-60 mm", "beam", ("width=0.08", "offset_range=0.06")),
    ("`beam` 6 cm, +-40 mm", "beam", ("width=0.06", "offset_range=0.04")),
    ("`beam-yaw` +10 deg", "beam-yaw", ("yaw=10",)),
    ("`stones`", "stones", ()),
]
"""Name, scene and settings."""


def cases() -> list[Case]:
    found: list[Case] = []
    for name, scene, settings in LINES:
        for robot in ROBOTS:
            found.append(Case(name, scene, robot, settings, SEEDS, plants=("drawn",)))
            found.append(Case(f"{name}, blind", scene, robot, (*settings, "footholds=off"), SEEDS, plants=("drawn",)))
    return found


COLUMNS = {
    **{n: n for n in ("fell", "steps_planned", "steps_taken", "sim_time_s", "tilt_max_deg", "zmp_margin_min_m")},
    "com_error_max_m": lambda simulation, out: max(out["estimate"]["com_error_max_m"]),
    "control_p99_us": "control_us.p99",
    "replans": "replans",
    "foothold_error_p95_m": "footholds.centroid_error_m.p95",
    "area_ratios": lambda simulation, out: " ".join(f"{v:g}" for v in out["contact_area_ratio"]),
    "zmp_margins_mm": lambda simulation, out: " ".join(
        "-" if v is None else f"{1e3 * v:.1f}" for v in out["zmp_margins_m"]
    ),
}


def report() -> None:
    rows, lines = latest(rows_of(BENCHMARK.path)), []
    for name, *_ in LINES:
        for robot in ROBOTS:
            mine, blind = (
                [r for r in rows if r["case"] == n and r["robot"] == robot] for n in (name, f"{name}, blind")
            )
            if not mine:
                continue
            seen, mine = counted(mine), of_now(mine)
            good = [r for r in mine if r["completed"] == "True"]
            shares = [min(map(float, r["area_ratios"].split())) for r in good if r["area_ratios"]]
            margins = [float(v) for r in good for v in r["zmp_margins_mm"].split() if v != "-"]
            errors = values(mine, "foothold_error_p95_m", 1e3)
            share = f"{min(shares):.2f}" if shares else ""
            margin = f"{round(median(margins))}" if margins else ""
            lines.append((name, robot, "used", *seen, share, margin, f"{median(errors):.1f}" if errors else ""))
            lines.append((name, robot, "off", *counted(blind), "", "", ""))
    head = ["scene", "robot", "soles' view", *HEADS, "smallest true share of the sole"]
    head += ["true ZMP margin of a step, median [mm]", "centroid error, 95 % of a run [mm]"]
    write_table(FOLDER / "footholds.md", [markdown_table(head, lines), "", origin(BENCHMARK)])


BENCHMARK = Benchmark("footholds", COLUMNS, cases())
