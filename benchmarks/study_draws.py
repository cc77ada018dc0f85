"""How often a study finds a difference that is not there, and how well one that is: draws of 20 recordings each.

python benchmarks/study_draws.py RECORDING [DRAWS]        (writes benchmarks/study_draws.md; 100 draws take 6 min)

Ten people are made of a real walk in two insoles for each draw: strides cut from it at left heel strikes and mixed,
slower or faster, lighter or heavier, and more or less on the forefoot. Each walks in two conditions, "before" and
"after". In the null draws they differ by chance alone; in the others "after" takes off 10 % of all pressures and
prolongs each stride by 6 %.
"""

import sys
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.bench.tables import markdown_table
from plantar.common.sides import SIDES
from plantar.gait.analysis.analyse import analyse
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.study.compare_conditions import Comparison, compare_conditions
from plantar.gait.analysis.study.one_recording import RecordingResult, measure_recording
from plantar.gait.analysis.study.participants import Participation
from plantar.layouts.layout_file import write_layout

FOLDER = Path(__file__).parent
PEOPLE, STRIDES = 10, 10
LIGHTER, LONGER = 0.9, 1.06
EFFECTS = 20
"""Draws with the effect."""


class Strides(NamedTuple):
    """Strides of a recording, each the frames of both feet (n, 2, k) in N, its rate in Hz, and the cells in front."""

    frames: list[NDArray[np.float64]]
    rate: float
    front: NDArray[np.bool_]


class Person(NamedTuple):
    """What stays with a person: body weight, pace and load of the forefoot next to the real walk's."""

    weight: float
    pace: float
    forefoot: float


def strides_of(path: Path, folder: Path) -> Strides:
    """Cut a recording at the heel strikes of its left foot; its layout is written to layout.json in a folder."""
    walk = analyse(path)
    feet = [walk.recording.feet[side] for side in SIDES]
    layout = feet[0].layout
    write_layout(layout, folder / "layout.json")
    forces = np.stack([np.nan_to_num(foot.force) for foot in feet], axis=1)
    begins = [contact.begin for contact in walk.feet["left"].contacts if contact.complete]
    front = layout.positions[:, 0] > 0.5 * layout.outline[:, 0].max()
    frames = [forces[a:b] for a, b in pairwise(begins)]
    return Strides(frames, walk.recording.rate_hz, front)


def write_walk(strides: Strides, who: Person, path: Path, random: np.random.Generator, effect: bool) -> None:
    """Write a walk of a person: random strides, each varied a little."""
    parts = []
    for index in random.integers(0, len(strides.frames), STRIDES + 2):
        frames = strides.frames[index]
        slow = who.pace * random.normal(1.0, 0.02) * (LONGER if effect else 1.0)
        count = round(len(frames) * slow)
        at = np.linspace(0.0, len(frames) - 1.0, count)
        low = np.minimum(at.astype(int), len(frames) - 2)
        share = (at - low)[:, None, None]
        part = (1.0 - share) * frames[low] + share * frames[low + 1]
        part = part * who.weight * random.normal(1.0, 0.03) * (LIGHTER if effect else 1.0)
        part[..., strides.front] *= who.forefoot * random.normal(1.0, 0.03)
        parts.append(part)
    forces = np.concatenate(parts)
    time = np.arange(len(forces)) / strides.rate
    np.savez(path, time=time, unit="N", left=forces[:, 0], right=forces[:, 1])


def draw(strides: Strides, folder: Path, seed: int, effect: bool) -> Comparison:
    random = np.random.default_rng(seed)
    results: list[RecordingResult] = []
    for number in range(PEOPLE):
        who = Person(*random.normal(1.0, (0.12, 0.06, 0.1)))
        for condition in ("before", "after"):
            # What a day, a shoe or a pair of insoles adds by itself.
            today = Person(*(np.array(who) * random.normal(1.0, (0.02, 0.02, 0.03))))
            write_walk(strides, today, folder / "walk.npz", random, effect and condition == "after")
            row = Participation("walk.npz", f"p{number}", condition, layout="layout.json")
            results.append(measure_recording(folder, row, AnalysisOptions(), ""))
    (comparison,) = compare_conditions(results)
    return comparison


def found(comparison: Comparison) -> tuple[bool, bool, bool]:
    """Whether the table, the curves and the maps show that the conditions differ."""
    curve, area = comparison.curve_test, comparison.map_test
    table = any(effect.p_all <= 0.05 for effect in comparison.effects.values())
    return table, bool(curve.significant.any()), bool(area.significant.any())


def null_rows(strides: Strides, folder: Path, draws: int) -> list[tuple[str, ...]]:
    hits = []
    for seed in range(1000, 1000 + draws):
        hits.append(found(draw(strides, folder, seed, effect=False)))
        print(f"null {len(hits)}: {np.sum(hits, axis=0)}", flush=True)
    counts = np.sum(hits, axis=0)
    names = ("a measure of the table (p of all)", "the force curves", "the pressure maps")
    return [(name, f"{count} of {draws}") for name, count in zip(names, counts, strict=True)]


def effect_rows(strides: Strides, folder: Path) -> list[tuple[str, ...]]:
    """Rows of the table of draws with the effect: true change, found on average, in the interval, found at all."""
    comparisons = [draw(strides, folder, 2000 + n, effect=True) for n in range(EFFECTS)]
    rows = []
    for key, title, true in (
        ("stride_time_s", "stride time", LONGER),
        ("contact_time_s", "contact time", LONGER),
        ("peak_force_N", "peak force", LIGHTER),
        ("peak_pressure_Pa", "peak pressure", LIGHTER),
        ("impulse_Ns", "impulse", LIGHTER * LONGER),
        ("stance_percent", "stance, % of the stride", 1.0),
    ):
        effects = [c.effects[key] for c in comparisons]
        change = np.mean([e.difference / e.mean_a for e in effects])
        inside = sum(e.low <= (true - 1.0) * e.mean_a <= e.high for e in effects)
        called = sum(e.p_all <= 0.05 for e in effects)
        wrong = sum(e.p_all <= 0.05 and (e.difference > 0.0) != (true > 1.0) for e in effects)
        counts = map(str, (inside, called, wrong))
        rows.append((title, f"{100.0 * (true - 1.0):+.1f} %", f"{100.0 * change:+.1f} %", *counts))
    return rows


def main() -> None:
    draws = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    with TemporaryDirectory() as name:
        folder = Path(name)
        strides = strides_of(Path(sys.argv[1]), folder)
        head = ("measure", "true", "found, mean", "truth in the 95 % interval", "called (p of all up to 0.05)")
        effects = markdown_table((*head, "of wrong sign"), effect_rows(strides, folder))
        print(effects, flush=True)
        nulls = markdown_table(("what", "studies"), null_rows(strides, folder, draws))
    lines = [
        "# Studies with and without a true difference",
        "",
        f"Ten people in two conditions, of {len(strides.frames)} strides of a real walk in insoles, cut and mixed.",
        "Written by `python benchmarks/study_draws.py RECORDING`.",
        "",
        "Without a difference but chance, one was reported in",
        "",
        nulls,
        "",
        f"{EFFECTS} studies in which the second condition takes {100 * (1 - LIGHTER):.0f} % off all pressures and "
        f"prolongs strides by {100 * (LONGER - 1):.0f} %:",
        "",
        effects,
        "",
    ]
    (FOLDER / "study_draws.md").write_text("\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
