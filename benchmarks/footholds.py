"""What the soles' view of a foothold is worth, and a map: `python benchmarks/outcomes.py MINUTES footholds`."""

from statistics import median

import numpy as np
from resumable import FOLDER, HEADS, Benchmark, Case, counted, latest, of_now, origin, rows_of, values, write_table

from plantar.bench.tables import markdown_table

ROBOTS = ("h1", "hrp2kai")
BLIND = {"pebbles": "conform=false"}
"""What switches the soles' part in a walk off, where it is not `footholds=off`."""

# name, scene, settings, and seeds
LINES: list[tuple[str, str, tuple[str, ...], int]] = [
    *((f"`partial-{part}`", f"partial-{part}", (), 20) for part in ("rear", "front", "inner", "outer")),
    ("`partial-third`", "partial-third", (), 20),
    *((f"`partial-third` share {share}", "partial-third", (f"share={share}",), 20) for share in (0.25, 0.2)),
    ("`beam` 12 cm, +-80 mm", "beam", (), 20),
    ("`beam` 8 cm, +-60 mm", "beam", ("width=0.08", "offset_range=0.06"), 20),
    ("`beam` 6 cm, +-40 mm", "beam", ("width=0.06", "offset_range=0.04"), 20),
    ("`beam` 5 cm, +-40 mm", "beam", ("width=0.05", "offset_range=0.04"), 20),
    ("`beam` 4 cm, +-40 mm", "beam", ("width=0.04", "offset_range=0.04"), 20),
    *((f"`beam-yaw` {yaw:+d} deg", "beam-yaw", (f"yaw={yaw}",), 20) for yaw in (5, -5)),
    *((f"`beam-yaw` {yaw:+d} deg", "beam-yaw", (f"yaw={yaw}",), 20) for yaw in (10, -10)),
    ("`beam-forward`", "beam-forward", (), 20),
    ("`stones`", "stones", (), 20),
    ("`pebbles`", "pebbles", (), 20),
    ("`pebbles` level, to 15 mm", "pebbles", ("slope_range=0",), 10),
    ("`pebbles` level, 5 mm", "pebbles", ("slope_range=0", "bump_max=0.005"), 10),
    ("`pebbles` slopes alone", "pebbles", ("bumps=0",), 10),
]

WIDTHS = (0.12, 0.08, 0.06)
DISTURBANCES: list[tuple[str, tuple[str, ...]]] = [
    ("none", ()),
    *((f"noise {n} N", (f"force_noise={n}",)) for n in (4.0, 8.0)),
    *((f"dead {round(100 * d)} %", (f"dead_taxels={d}",)) for d in (0.1, 0.2, 0.3)),
    *((f"delay {4 * p} ms", (f"delay_periods={p}",)) for p in (3, 5)),
    *((f"push {i} N s", (f"impulse={i}",)) for i in (10, 20, 30)),
]
MAP_SEEDS = 2


def cases() -> list[Case]:
    found: list[Case] = []
    for name, scene, settings, seeds in LINES:
        off = BLIND.get(scene, "footholds=off")
        for robot in ROBOTS:
            found.append(Case(name, scene, robot, settings, seeds))
            found.append(Case(f"{name}, blind", scene, robot, (*settings, off), seeds, aside=True))
    for width in WIDTHS:
        for name, settings in DISTURBANCES:
            # The same share of the offsets that leave something of each beam under the sole.
            place = (f"width={width}", f"offset_range={0.08 * (width / 0.12):.3f}")
            found.append(Case(f"map {width} {name}", "beam", "h1", (*place, *settings), MAP_SEEDS, aside=True))
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
    _draw_map(rows)


def _draw_map(rows: list[dict[str, str]]) -> None:
    from plantar.plotting import new_figure, save_figure

    names = [name for name, _ in DISTURBANCES]
    share = np.full((len(WIDTHS), len(names)), np.nan)
    texts = {}
    for i, width in enumerate(WIDTHS):
        for j, name in enumerate(names):
            mine = [r for r in rows if r["case"] == f"map {width} {name}"]
            if mine:
                share[i, j] = sum(r["completed"] == "True" for r in mine) / len(mine)
                texts[i, j] = f"{sum(r['completed'] == 'True' for r in mine)}/{len(mine)}"
    figure, axis = new_figure(8.0, 3.0)
    image = axis.imshow(100.0 * share, cmap="RdYlGn", vmin=0.0, vmax=100.0, aspect="auto")
    for (i, j), text in texts.items():
        axis.text(j, i, text, ha="center", va="center", fontsize=8)
    axis.set_xticks(range(len(names)), names, rotation=30, ha="right", fontsize=8)
    axis.set_yticks(range(len(WIDTHS)), [f"{100 * w:.0f}" for w in WIDTHS])
    axis.set_ylabel("width of the beam [cm]")
    axis.set_title(
        "H1: crossings of 50 side steps, offset drawn from two thirds of the width to either side", fontsize=9
    )
    figure.colorbar(image, ax=axis, label="crossed [%]")
    save_figure(figure, FOLDER / "footholds_map.png")


BENCHMARK = Benchmark("footholds", COLUMNS, cases())
