"""What feedback, and steps that move, are worth under pushes: `python benchmarks/outcomes.py MINUTES push`."""

from statistics import median

from resumable import FOLDER, HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

from plantar.bench.tables import markdown_table

COLUMNS = {
    "fell": "fell",
    "direction": "push.direction",
    "step": "push.step",
    **{name: name for name in ("steps_taken", "tilt_max_deg", "zmp_margin_min_m")},
    "impact_median_N": lambda simulation, out: median(out["impacts_N"] or [0.0]),
    "impact_max_N": lambda simulation, out: max(out["impacts_N"], default=0.0),
    "position_error_m": "final.position_error_m",
    "heading_error_deg": "final.heading_error_deg",
    "com_error_max_m": lambda simulation, out: max(out["estimate"]["com_error_max_m"]),
}

# robot and impulse in N s
LINES = (("h1", 20), ("h1", 25), ("h1", 30), ("h1", 40), ("hrp2kai", 20), ("hrp2kai", 25))

_NO_STEPS = ("control.step_adjustment=false",)
WAYS: dict[str, tuple[str, ...]] = {
    "steps": (),
    "no step moves": _NO_STEPS,
    "no lean": ("lean=false",),
    "feedback off": (*_NO_STEPS, "feedback=false"),
}
"""What balances, with its settings. Each changes one thing of the first, the last one of the second."""

_OLDER = {"steps": "steps", "feedback on": "no step moves, no lean", "feedback off": "feedback off, no lean"}
"""What the ways of older rows were."""


def _name(impulse: int, way: str) -> str:
    return f"{impulse} N s, {way}"


def _cases() -> list[Case]:
    return [
        Case(_name(n, way), "push", robot, (f"impulse={n}", *settings), 20)
        for robot, n in LINES
        for way, settings in WAYS.items()
    ]


def report() -> None:
    from plantar.plotting import COLOURS, new_figure, save_figure

    rows = rows_of(BENCHMARK.path)
    for r in rows:  # the older ablations took away the lean as well
        impulse, _, way = r["case"].partition(", ")
        if not r.get("plant") and way in _OLDER:
            r["case"] = f"{impulse}, {_OLDER[way]}"
    ways = dict.fromkeys([*WAYS, *_OLDER.values()])
    lines = []
    bars: list[tuple[str, list[float]]] = []
    for robot, impulse in LINES:
        shares = []
        for way in ways:
            mine = [r for r in rows if r["robot"] == robot and r["case"] == _name(impulse, way)]
            if mine:
                lines.append((robot, f"{impulse} N s", way, *counted(mine)))
            now = of_now(mine)
            shares.append(100.0 * sum(r["completed"] == "True" for r in now) / max(len(now), 1))
        bars.append((f"{robot}\n{impulse} N s", shares))
    table = markdown_table(("robot", "impulse", "what balances", *HEADS), lines)
    write_table(FOLDER / "push.md", [table, "", origin(BENCHMARK)])
    figure, axis = new_figure(6.0, 3.2)
    colours = [COLOURS[name] for name in ("polygon", "left", "right", "reference")]
    for i, (way, colour) in enumerate(zip(WAYS, colours, strict=True)):
        places = [k + 0.2 * (i - 1.5) for k in range(len(bars))]
        axis.bar(places, [shares[i] for _, shares in bars], 0.18, color=colour, label=way)
    axis.set_xticks(range(len(bars)), [name for name, _ in bars], fontsize=8)
    axis.set_ylabel("completed, all seeds [%]")
    axis.legend(fontsize=8)
    save_figure(figure, FOLDER / "push.png")


BENCHMARK = Benchmark("push", COLUMNS, _cases())
