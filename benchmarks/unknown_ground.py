"""What preemptive foot compliance and step feasibility are worth: the table, its bars and forces.

`python benchmarks/outcomes.py MINUTES unknown_ground` runs what is missing and writes table and bars; `python
benchmarks/unknown_ground.py` draws the forces on the slab.
"""

from pathlib import Path
from typing import Any

import numpy as np
from resumable import FOLDER, SPREAD, Benchmark, Case, Row, of_now, rows_of, shown, values

from plantar.mechanics.lip import GRAVITY

ROBOTS = ("h1", "hrp2kai")

SEEDS = 2
_ON_BOTH: list[tuple[str, str, tuple[str, ...]]] = [
    ("uneven forward, on", "uneven", ()),
    ("uneven forward, off", "uneven", ("pfc=false",)),
    ("obstacle 3 cm, on", "obstacle", ()),
    ("obstacle 3 cm, off", "obstacle", ("pfc=false",)),
    *((f"feasibility-{k}, skin", f"feasibility-{k}", ()) for k in range(1, 5)),
    ("tilt pitch +10", "tilt", ("pitch=10",)),
    ("tilt roll -10", "tilt", ("pitch=0", "roll=-10")),
]
_ON_ONE: list[tuple[str, str, tuple[str, ...]]] = [
    (f"feasibility-{k}, force-torque", f"feasibility-{k}", ("feasibility=force_torque",)) for k in range(1, 5)
]
"""Name, scene and settings."""

CASES = [
    *(Case(name, scene, robot, more, SEEDS) for robot in ROBOTS for name, scene, more in _ON_BOTH),
    *(Case(name, scene, "h1", more, SEEDS) for name, scene, more in _ON_ONE),
]


def impacts(simulation: Any, out: dict[str, Any]) -> Any:
    """Impacts (n,) of a run in body weights."""
    return np.array(out["impacts_N"] or [np.nan]) / (simulation.legs.mass * GRAVITY)


def fifth(simulation: Any, out: dict[str, Any]) -> int | None:
    """The landing of the fifth step, the one on the scene's obstacle, or None."""
    swings = [p for p in simulation.controller.schedule.phases if p.swing is not None]
    if len(swings) <= 4:
        return None
    near = np.flatnonzero(np.abs(np.array(out["landings_s"]) - swings[4].end) < 0.45)
    return int(near[0]) if len(near) else None


def _at_fifth(values: Any) -> Any:
    return lambda s, out: "" if (k := fifth(s, out)) is None else round(float(values(s, out)[k]), 4)


def _checked(name: str) -> Any:
    return lambda simulation, out: (out.get("feasibility") or [{}])[0].get(name, "")


def stepped_on(rows: list[Row]) -> str:
    """How many of the checked places the robot stepped on."""
    checked = [r["feasible"] == "True" for r in rows if r["feasible"]]
    return f"{sum(checked)}/{len(checked)}" if checked else ""


BENCHMARK = Benchmark(
    "unknown_ground",
    {
        "fell": lambda simulation, out: int(out["fell"]),
        "steps": "steps_taken",
        "impact_mean": lambda simulation, out: round(float(impacts(simulation, out).mean()), 4),
        "impact_max": lambda simulation, out: round(float(impacts(simulation, out).max()), 4),
        "here": _at_fifth(impacts),
        "angle_deg": _at_fifth(lambda simulation, out: out["sole_angles_deg"]),
        "feasible": _checked("feasible"),
        "area_ratio": _checked("area_ratio"),
        "moment_Nm": _checked("ankle_moment_Nm"),
        "tilt_deg": "tilt_max_deg",
        "time_s": "sim_time_s",
        "rays_skipped": "skipped.proximity_rays",
    },
    CASES,
    {
        "mean impact [BW]": shown("impact_mean", SPREAD),
        "largest impact [BW]": shown("impact_max", SPREAD),
        "fifth landing [BW]": shown("here", SPREAD),
        "angle [deg]": shown("angle_deg", SPREAD),
        "stepped on": stepped_on,
    },
)


def report() -> None:
    from plantar.plotting import COLOURS, new_figure, save_figure

    BENCHMARK.report()
    rows = rows_of(BENCHMARK.path)
    figure, axis = new_figure(8.5, 3.6)
    names = [(c.name, c.robot) for c in CASES if c.name.startswith(("uneven", "obstacle 3"))]
    for i, case in enumerate(names):
        mine = of_now([r for r in rows if (r["case"], r["robot"]) == case])
        mean = values(mine, "impact_mean")
        top = values(mine, "impact_max")
        if not mean:
            continue
        colour = COLOURS["left"] if ", on" in case[0] else COLOURS["right"]
        axis.bar(i, max(top) - min(mean), bottom=min(mean), color=colour, alpha=0.35)
        axis.plot([i - 0.4, i + 0.4], [np.mean(mean)] * 2, color=colour, lw=2.5)
    labels = [", ".join(case).replace(", ", "\n").replace(" ", "\n", 1) for case in names]
    axis.set_xticks(range(len(names)), labels, fontsize=8)
    axis.set(ylabel="impact [body weights]", yscale="log")
    axis.grid(axis="y", alpha=0.3)
    save_figure(figure, FOLDER / "unknown_ground.png")


def forces() -> None:
    """Draw the ground force on each foot on the slab, without and with (T Fig. 51 and 55)."""
    from tempfile import TemporaryDirectory

    from plantar.common.sides import SIDES
    from plantar.plotting import COLOURS, new_figure, save_figure
    from plantar.recordings.recording import read_mcap
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


if __name__ == "__main__":
    forces()
