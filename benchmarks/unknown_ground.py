"""Count what preemptive foot compliance and step feasibility are worth: `python benchmarks/unknown_ground.py`.

Runs every case over its seeds, appends a row a run to benchmarks/unknown_ground.csv and writes the table
unknown_ground.md and the bars unknown_ground.png beside it. A run that is there already is not repeated, so a benchmark
that was stopped goes on where it was; rows of other code than today's are dropped first.
"""

from __future__ import annotations

import csv
import hashlib
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from statistics import median

import numpy as np

FOLDER = Path(__file__).parent
COLUMNS = ("code", "case", "seed", "completed", "fell", "steps", "impact_mean", "impact_max", "here", "angle_deg")
COLUMNS += ("feasible", "area_ratio", "moment_Nm", "tilt_deg", "time_s", "rays_skipped", "p99_us")
IN_PLACE = "walk.length=0"

# name, scene, settings, seeds
_ON_BOTH: list[tuple[str, str, tuple[str, ...], int]] = [
    ("feasibility-1, skin", "feasibility-1", (), 20),
    ("feasibility-2, skin", "feasibility-2", (), 20),
    ("feasibility-3, skin", "feasibility-3", (), 20),
    ("feasibility-4, skin", "feasibility-4", (), 20),
    ("obstacle 3 cm, on", "obstacle", (), 20),
    ("obstacle 3 cm, off", "obstacle", ("pfc=false",), 6),
    ("uneven forward, on", "uneven", (), 20),
    ("uneven forward, off", "uneven", ("pfc=false",), 6),
    ("uneven in place, on", "uneven", (IN_PLACE,), 20),
    ("uneven in place, off", "uneven", (IN_PLACE, "pfc=false"), 6),
    ("tilt pitch +10", "tilt", ("pitch=10",), 20),
    ("tilt pitch -10", "tilt", ("pitch=-10",), 20),
    ("tilt roll +10", "tilt", ("pitch=0", "roll=10"), 20),
    ("tilt roll -10", "tilt", ("pitch=0", "roll=-10"), 20),
    ("tilt pitch +5", "tilt", ("pitch=5",), 3),
    ("tilt pitch -5", "tilt", ("pitch=-5",), 3),
    ("tilt roll +5", "tilt", ("pitch=0", "roll=5"), 3),
    ("tilt roll -5", "tilt", ("pitch=0", "roll=-5"), 3),
    *[
        (f"slid in, {way} {sign}{size}", "tilt", (IN_PLACE, "pitch=0", f"{way}={sign}{size}", "slide=0.3"), 3)
        for way in ("pitch", "roll")
        for sign in ("+", "-")
        for size in (5, 10)
    ],
    ("obstacle 4 cm, on", "obstacle", ("top=0.04", "crouch=0.05"), 4),
    ("obstacle 5 cm, on", "obstacle", ("top=0.05", "crouch=0.05"), 4),
    *[(f"dead taxels {s}", "uneven", ("steps=20", f"dead_taxels={s}"), 3) for s in (0.1, 0.3, 0.5)],
    *[(f"bias {s} mm", "uneven", ("steps=20", f"proximity_bias={s / 1000}"), 3) for s in (-10, -5, 5, 10)],
    *[(f"delay {4 * s} ms", "uneven", ("steps=20", f"delay_periods={s}"), 3) for s in (3, 5, 8)],
    *[(f"noise {s} mm", "uneven", ("steps=20", f"proximity_noise={s / 1000}"), 3) for s in (5, 10)],
]
_FORCE_TORQUE: list[tuple[str, str, tuple[str, ...], int]] = [
    (f"feasibility-{k}, force-torque", f"feasibility-{k}", ("feasibility=force_torque",), 3) for k in range(1, 5)
]
ROBOTS = ("h1", "hrp2kai")
CASES = [*_ON_BOTH, *_FORCE_TORQUE, *[(f"{n}, hrp2kai", s, o, k) for n, s, o, k in _ON_BOTH]]


def code() -> str:
    """Short hash of the code that a row comes from: whatever walks, senses and simulates, and the scenes and robots."""
    digest = hashlib.sha1(usedforsecurity=False)
    for folder in ("gait", "plantar", "sim"):
        for path in sorted((FOLDER.parent / folder).rglob("*")):
            if path.suffix in (".py", ".pyx", ".c", ".h", ".toml", ".json"):
                digest.update(path.read_bytes())
    return digest.hexdigest()[:10]


def run(job: tuple[str, str, tuple[str, ...], int]) -> dict[str, object]:
    """One run as a row."""
    from sim.runner import Simulation
    from sim.scene import load_scene

    name, scene, settings, seed = job
    robot = ROBOTS[name.endswith(ROBOTS[1])]
    simulation = Simulation(load_scene(scene, settings, robot), seed)
    out = simulation.run()
    weight = simulation.legs.mass * 9.81
    impact = np.array(out["impacts_N"] or [np.nan]) / weight
    swings = [p for p in simulation.controller.schedule.phases if p.swing is not None]
    here = None
    if len(swings) > 4:  # the landing of the fifth step: the one on what the scene is about
        times = np.array(out["landings_s"])
        near = np.flatnonzero(np.abs(times - swings[4].end) < 0.45)
        here = int(near[0]) if len(near) else None
    checks = out.get("feasibility") or [{}]
    return {
        "code": code(),
        "case": name,
        "seed": seed,
        "completed": int(out["completed"]),
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
        "p99_us": out["control_us"]["p99"],
    }


def rows_of(path: Path) -> list[dict[str, str]]:
    """Rows that are there already."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def main(workers: int = 2) -> None:
    """Run what is missing and write the table."""
    path = FOLDER / "unknown_ground.csv"
    today = code()
    kept = [r for r in rows_of(path) if r.get("code") == today]
    done = {(r["case"], int(r["seed"])) for r in kept}
    jobs = [(n, s, o, k) for n, s, o, seeds in CASES for k in range(seeds) if (n, k) not in done]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(kept)
        file.flush()
        with ProcessPoolExecutor(workers) as pool:
            for row in pool.map(run, jobs):
                writer.writerow(row)
                file.flush()
                print(row["case"], row["seed"], "walked on" if row["completed"] else "did not", file=sys.stderr)
    report(rows_of(path))


def report(rows: list[dict[str, str]]) -> None:
    """Write the table between its markers in unknown_ground.md, and the bars."""
    from plantar.plotting import COLOURS, new_figure, save_figure

    lines = [
        "| case | walked on | mean impact [BW] | largest impact [BW] | fifth landing [BW] | angle [deg] | stepped on |",
        "|---|---|---|---|---|---|---|",
    ]
    bars: dict[str, tuple[float, float, float]] = {}
    for name, *_ in CASES:
        mine = [r for r in rows if r["case"] == name]
        if not mine:
            continue
        mean, top = ([float(r[k]) for r in mine] for k in ("impact_mean", "impact_max"))
        here = [float(r["here"]) for r in mine if r["here"]]
        angle = [float(r["angle_deg"]) for r in mine if r["angle_deg"]]
        stepped = [r["feasible"] == "True" for r in mine if r["feasible"]]
        count = f"{sum(stepped)}/{len(stepped)}" if stepped else ""
        bars[name] = (min(mean), float(np.mean(mean)), max(top))
        lines.append(
            f"| {name} | {sum(int(r['completed']) for r in mine)}/{len(mine)} | {_range(mean)} | {_range(top)} | "
            f"{_range(here)} | {_range(angle)} | {count} |"
        )
    path = FOLDER / "unknown_ground.md"
    text = path.read_text(encoding="utf-8") if path.exists() else "<!-- table -->\n<!-- end -->\n"
    before, _, rest = text.partition("<!-- table -->\n")
    after = rest.partition("<!-- end -->\n")[2]
    path.write_text(f"{before}<!-- table -->\n" + "\n".join(lines) + f"\n<!-- end -->\n{after}", encoding="utf-8")
    figure, axis = new_figure(7.0, 3.2)
    shown = [n for n in bars if n.startswith(("uneven", "obstacle 3"))]
    for i, name in enumerate(shown):
        low, mean, high = bars[name]
        colour = COLOURS["left"] if ", on" in name else COLOURS["right"]
        axis.bar(i, high - low, bottom=low, color=colour, alpha=0.35)
        axis.plot([i - 0.4, i + 0.4], [mean, mean], color=colour, lw=2.5)
    axis.set_xticks(range(len(shown)), [n.replace(", ", "\n") for n in shown], fontsize=8)
    axis.set_ylabel("impact [body weights]")
    axis.set_yscale("log")
    axis.grid(axis="y", alpha=0.3)
    save_figure(figure, FOLDER / "unknown_ground.png")


def _range(values: list[float]) -> str:
    return f"{median(values):.3g} ({min(values):.3g} to {max(values):.3g})" if values else ""


def forces() -> None:
    """Draw the ground force on the slab, without and with."""
    from tempfile import TemporaryDirectory

    from sim.figures import plot_landing_forces
    from sim.runner import run_scene
    from sim.scene import load_scene

    with TemporaryDirectory() as folder:
        runs = {name: Path(folder) / f"{name}.mcap" for name in ("off", "on")}
        run_scene(load_scene("obstacle", ["pfc=false"]), 0, record=runs["off"])
        run_scene(load_scene("obstacle"), 0, record=runs["on"])
        plot_landing_forces(runs, FOLDER / "unknown_ground_force.png")


if __name__ == "__main__":
    if sys.argv[1:] == ["report"]:
        report(rows_of(FOLDER / "unknown_ground.csv"))
    else:
        main()
        forces()
