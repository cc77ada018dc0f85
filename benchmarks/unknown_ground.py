"""Count what preemptive foot compliance and step feasibility are worth: the table, its bars and forces.

`python benchmarks/outcomes.py MINUTES unknown_ground` runs what is missing in unknown_ground.csv and writes table and
bars; `python benchmarks/unknown_ground.py` draws the forces on the slab.
"""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from resumable import HEADS, Benchmark, Case, counted, of_now, origin, rows_of, write_table

from plantar.mechanics.lip import GRAVITY

FOLDER = Path(__file__).parent
COLUMNS = ("fell", "steps", "impact_mean", "impact_max", "here", "angle_deg", "feasible", "area_ratio")
COLUMNS += ("moment_Nm", "tilt_deg", "time_s", "rays_skipped")
IN_PLACE = "walk.length=0"
ROBOTS = ("h1", "hrp2kai")

# name, scene, settings, seeds
_ON_BOTH: list[tuple[str, str, tuple[str, ...], int]] = [
    ("uneven forward, on", "uneven", (), 20),
    ("uneven forward, off", "uneven", ("pfc=false",), 3),
    ("uneven in place, on", "uneven", (IN_PLACE,), 20),
    ("uneven in place, off", "uneven", (IN_PLACE, "pfc=false"), 3),
    ("obstacle 3 cm, on", "obstacle", (), 20),
    ("obstacle 3 cm, off", "obstacle", ("pfc=false",), 3),
    *((f"feasibility-{k}, skin", f"feasibility-{k}", (), 20) for k in range(1, 5)),
    *((f"tilt pitch {v:+d}", "tilt", (f"pitch={v}",), 20) for v in (10, -10)),
    *((f"tilt roll {v:+d}", "tilt", ("pitch=0", f"roll={v}"), 20) for v in (10, -10)),
]
_ON_ONE: list[tuple[str, str, tuple[str, ...], int]] = [
    *((f"tilt pitch {v:+d}", "tilt", (f"pitch={v}",), 3) for v in (5, -5)),
    *((f"tilt roll {v:+d}", "tilt", ("pitch=0", f"roll={v}"), 3) for v in (5, -5)),
    *(
        (f"slid in, {way} {v:+d}", "tilt", (IN_PLACE, "pitch=0", f"{way}={v}", "slide=0.3"), 3)
        for way in ("pitch", "roll")
        for v in (5, -5, 10, -10)
    ),
    *((f"feasibility-{k}, force-torque", f"feasibility-{k}", ("feasibility=force_torque",), 3) for k in range(1, 5)),
    *((f"obstacle {v} cm, on", "obstacle", (f"top={v / 100}", "crouch=0.05"), 3) for v in (4, 5)),
    *((f"dead taxels {v}", "uneven", ("steps=20", f"dead_taxels={v}"), 2) for v in (0.1, 0.3, 0.5)),
    *((f"bias {v} mm", "uneven", ("steps=20", f"proximity_bias={v / 1000}"), 2) for v in (-10, -5, 5, 10)),
    *((f"delay {4 * v} ms", "uneven", ("steps=20", f"delay_periods={v}"), 2) for v in (3, 5, 8)),
    *((f"noise {v} mm", "uneven", ("steps=20", f"proximity_noise={v / 1000}"), 2) for v in (5, 10)),
]
CASES = [
    *(
        Case(name, scene, robot, settings, seeds, aside=seeds < 20)
        for robot in ROBOTS
        for name, scene, settings, seeds in _ON_BOTH
    ),
    *(Case(name, scene, "h1", settings, seeds, aside=True) for name, scene, settings, seeds in _ON_ONE),
]


def figures(simulation: Any, out: dict[str, Any]) -> dict[str, Any]:
    """The columns of one run."""
    weight = simulation.legs.mass * GRAVITY
    impact = np.array(out["impacts_N"] or [np.nan]) / weight
    swings = [p for p in simulation.controller.schedule.phases if p.swing is not None]
    here = None
    if len(swings) > 4:  # the landing of the fifth step: the one on what the scene is about
        times = np.array(out["landings_s"])
        near = np.flatnonzero(np.abs(times - swings[4].end) < 0.45)
        here = int(near[0]) if len(near) else None
    checks = out.get("feasibility") or [{}]
    return {
        "fell": int(out["fell"]),
        "steps": out["steps_taken"],
        "impact_mean": round(float(impact.mean()), 4),
        "impact_max": round(float(impact.max()), 4),
        "here": "" if here is None else round(float(impact[here]), 4),
        "angle_deg": "" if here is None else out["sole_angles_deg"][here],
        "feasible": checks[0].get("feasible", ""),
        "area_ratio": checks[0].get("area_ratio", ""),
        "moment_Nm": checks[0].get("ankle_moment_Nm", ""),
        "tilt_deg": out["tilt_max_deg"],
        "time_s": out["sim_time_s"],
        "rays_skipped": out["skipped"].get("proximity_rays", ""),
    }


def report() -> None:
    """Write the table between its markers in unknown_ground.md, and the bars."""
    from plantar.plotting import COLOURS, new_figure, save_figure

    rows = rows_of(BENCHMARK.path)
    lines = [
        f"| case | robot | {HEADS} | mean impact [BW] | largest impact [BW] | fifth landing [BW] "
        "| angle [deg] | stepped on |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    bars: dict[str, tuple[float, float, float]] = {}
    for case in CASES:
        mine = [r for r in rows if r["case"] == case.name and r["robot"] == case.robot]
        if not mine:
            continue
        cells, mine = counted(mine), of_now(mine)
        mean, top = ([float(r[k]) for r in mine] for k in ("impact_mean", "impact_max"))
        here = [float(r["here"]) for r in mine if r["here"]]
        angle = [float(r["angle_deg"]) for r in mine if r["angle_deg"]]
        stepped = [r["feasible"] == "True" for r in mine if r["feasible"]]
        checked = f"{sum(stepped)}/{len(stepped)}" if stepped else ""
        bars[f"{case.name}, {case.robot}"] = (min(mean), float(np.mean(mean)), max(top))
        lines.append(
            f"| {case.name} | {case.robot} | {cells} | {_range(mean)} "
            f"| {_range(top)} | {_range(here)} | {_range(angle)} | {checked} |"
        )
    write_table(FOLDER / "unknown_ground.md", [*lines, "", origin(BENCHMARK)])
    figure, axis = new_figure(8.5, 3.6)
    shown = [n for n in bars if n.startswith(("uneven", "obstacle 3"))]
    for i, name in enumerate(shown):
        low, mean, high = bars[name]
        colour = COLOURS["left"] if ", on" in name else COLOURS["right"]
        axis.bar(i, high - low, bottom=low, color=colour, alpha=0.35)
        axis.plot([i - 0.4, i + 0.4], [mean, mean], color=colour, lw=2.5)
    axis.set_xticks(range(len(shown)), [n.replace(", ", "\n").replace(" ", "\n", 1) for n in shown], fontsize=8)
    axis.set_ylabel("impact [body weights]")
    axis.set_yscale("log")
    axis.grid(axis="y", alpha=0.3)
    save_figure(figure, FOLDER / "unknown_ground.png")


def _range(values: list[float]) -> str:
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})" if values else ""


def forces() -> None:
    """Draw the ground force on each foot on the slab, without and with (T Fig. 51 and 55)."""
    from tempfile import TemporaryDirectory

    from plantar.plotting import COLOURS, new_figure, save_figure
    from plantar.recordings.recording import read_mcap
    from plantar.sides import SIDES
    from plantar.sim.run.runner import run_scene
    from plantar.sim.run.scene import load_scene

    figure, axes = new_figure(8.0, 4.4, 2, 1, sharex=True, sharey=True)
    with TemporaryDirectory() as folder:
        for axis, name in zip(axes, ("off", "on"), strict=True):
            path = Path(folder) / f"{name}.mcap"
            run_scene(load_scene("obstacle", ["pfc=false"] if name == "off" else []), 0, record=path)
            for side, foot in ((s, read_mcap(path).topics[f"/truth/{s}"]) for s in SIDES):
                axis.plot(foot.time, foot.fields["normal_force"][:, 0], color=COLOURS[side], lw=0.7, label=side)
            axis.set_ylabel(f"{name}\nground force [N]")
            axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8, ncol=2)
    axes[1].set_xlabel("time [s]")
    save_figure(figure, FOLDER / "unknown_ground_force.png")


BENCHMARK = Benchmark(FOLDER / "unknown_ground.csv", COLUMNS, CASES, figures)

if __name__ == "__main__":
    forces()
