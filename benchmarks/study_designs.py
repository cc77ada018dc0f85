"""How often studies of eight designs find what is not there, and whether they find what is.

python benchmarks/study_designs.py PART...      (parts: 1 to 8, effect, whole; each up to 5 minutes)

Each part is written to benchmarks/study_designs.csv, and the page study_designs.md of all of them.

Each draw is a table of steps: people differ, so do their conditions, trials and steps, which are skewed, and measures
depend on one another. Means of participants are compared as a study compares them, over 20 measures, a curve of 101
values and a map of 36 x 14 places. A difference that is not there is one by p of all (measures) or by a cluster.

The study with an effect is made of footsteps in files and goes the whole way: 20 people, 3 trials, 2 and 4 conditions,
the last of which takes a fifth off the pressure under the left heel and is walked faster.

Whole draws go from files through the command to its tables: made footsteps of 20 people, 3 trials in each of two
conditions that differ by chance, speed allowed for.
"""

import csv
import hashlib
import json
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from made_walkway import made_walk, metadata_of, upright, walker, write_stack
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from plantar.bench.tables import made_on, markdown_table, write_rows
from plantar.gait.analysis.study.designs import Design, compare_levels
from plantar.gait.analysis.study.one_against_group import deviation_of
from plantar.gait.analysis.study.run_study import Study, run_study
from plantar.gait.analysis.study.statistics import Effect
from plantar.gait.analysis.study.study_options import StudyOptions

FOLDER = Path(__file__).parent
PEOPLE = 20
TRIALS, STEPS = 3, 10
MEASURES = 20
DRAWS = 250
"""Draws of each design: 2,000 in all."""

PERMUTATIONS = 100
"""Permutations of each test: p is a multiple of 1/100, so that 5 % is met exactly; a study takes 500 or 2,000."""

GROUP = 39  # people of a group that one is compared with: 2 / (39 + 1) is 5 %
_GRID = (36, 14)
# Shape of measures, curves and maps, and how wide curves and maps are smoothed, in their places; measures are mixed.
_KINDS: tuple[tuple[tuple[int, ...], tuple[float, ...]], ...] = (
    ((MEASURES,), ()),
    ((101,), (6.0,)),
    (_GRID, (3.0, 2.0)),
)
_LEFT_HEEL = 0.8
_FASTER = 0.94  # times the step time in the condition with the effect


WHOLE_DRAWS = 50
_WALKERS, _WALKS, _STEPS_OF_WALK = 30, 10, 4  # from which whole draws take people, their trials, and footsteps of each


class Draw(NamedTuple):
    """Rows of means (r, k) of three kinds, which are measures, curves and maps, and their design."""

    values: Sequence[NDArray[np.float64]]
    design: Design


def steps_to_means(random: np.random.Generator, rows: int, people: NDArray[np.int64], own: float = 1.0) -> Draw:
    """Means of rows, one for each person and condition: of people, conditions, trials, and skewed steps."""
    mixing = random.normal(size=(MEASURES, MEASURES))
    kinds = []
    for shape, wide in _KINDS:

        def noise(
            count: tuple[int, ...], shape: tuple[int, ...] = shape, wide: tuple[float, ...] = wide
        ) -> NDArray[np.float64]:
            raw = random.normal(size=(*count, *shape))
            return _smooth(raw, wide) if wide else raw

        person = own * noise((int(people.max()) + 1,))[people]
        condition = 0.5 * noise((rows,))
        trial = 0.4 * noise((rows, TRIALS)).mean(axis=1)
        # Steps are skewed: their mean over trials and steps is that of an exponential variable.
        step = random.exponential(size=(rows, TRIALS * STEPS, *((1,) * len(shape)))) - 1.0
        steps = (step * noise((rows, 1))).mean(axis=1)
        value = (person + condition + trial + steps).reshape(rows, -1)
        kinds.append(value if wide else value @ mixing)
    level = np.zeros(rows, dtype=np.int64)
    return Draw(kinds, Design(people, level, np.zeros((rows, 0)), within=True))


def _smooth(values: NDArray[np.float64], wide: tuple[float, ...]) -> NDArray[np.float64]:
    smooth: NDArray[np.float64] = gaussian_filter(values, (*((0.0,) * (values.ndim - len(wide))), *wide))
    return np.asarray(smooth / smooth.std())


def conditions(random: np.random.Generator, levels: int, covariate: bool = False) -> Draw:
    people, level = np.divmod(np.arange(PEOPLE * levels), levels)
    draw = steps_to_means(random, len(people), people)
    known = np.zeros((len(people), 0))
    values = draw.values
    if covariate:  # a speed that differs between conditions and moves all values
        speed = random.normal(size=(len(people), 1)) + 0.8 * level[:, None]
        values = [own + 0.7 * speed * random.normal(size=own.shape[1]) for own in values]
        known = speed
    return Draw(values, Design(people, level, known, within=True))


def groups(random: np.random.Generator, levels: int) -> Draw:
    people = np.arange(PEOPLE * levels)
    draw = steps_to_means(random, len(people), people)
    return Draw(draw.values, Design(people, people % levels, np.zeros((len(people), 0)), within=False))


def changes(random: np.random.Generator) -> Draw:
    """Change between two conditions of each person, compared between two groups: their interaction."""
    people, level = np.divmod(np.arange(4 * PEOPLE), 2)
    draw = steps_to_means(random, len(people), people)
    values = [own[level == 1] - own[level == 0] for own in draw.values]
    who = np.arange(2 * PEOPLE)
    return Draw(values, Design(who, who % 2, np.zeros((len(who), 0)), within=False))


def found(draw: Draw) -> list[bool]:
    """Whether measures, curves and maps show a difference."""
    out = []
    for values, (shape, wide) in zip(draw.values, _KINDS, strict=True):
        contrasts = compare_levels(values, draw.design, np.ones(shape, dtype=bool) if wide else None, PERMUTATIONS)
        called = (c.significant if wide else c.p_all <= 0.05 for c in contrasts)
        out.append(any(bool(places.any()) for places in called))
    return out


def one_against(random: np.random.Generator) -> list[bool]:
    draw = steps_to_means(random, GROUP + 1, np.arange(GROUP + 1))
    return [bool(deviation_of(values[0], values[1:]).differs.any()) for values in draw.values]


DESIGNS: dict[str, Callable[[np.random.Generator], list[bool]]] = {
    "two conditions": lambda random: found(conditions(random, 2)),
    "four conditions": lambda random: found(conditions(random, 4)),
    "two conditions, speed allowed for": lambda random: found(conditions(random, 2, covariate=True)),
    "four conditions, speed allowed for": lambda random: found(conditions(random, 4, covariate=True)),
    "two groups": lambda random: found(groups(random, 2)),
    "four groups": lambda random: found(groups(random, 4)),
    "repeated measures: change between conditions in two groups": lambda random: found(changes(random)),
    "one against a group": one_against,
}


def planted(folder: Path, levels: int) -> Study:
    """Study of made footsteps, the last condition of which has the effect and is walked faster."""
    for person in range(1, PEOPLE + 1):
        random = np.random.default_rng(person)
        who = walker(random)
        for level in range(levels):
            last = level == levels - 1
            pace = _FASTER if last else 1.0
            own = replace(who, left_heel=_LEFT_HEEL if last else 1.0, period=pace * who.period)
            own = replace(own, stance=pace * own.stance)
            for trial in range(TRIALS):
                target = folder / f"{person:03}" / f"C{level}" / f"W{trial}"
                write_stack(target, made_walk(own, 420, random), person, f"C{level}", f"W{trial}")
    plan = StudyOptions(factors=("condition", "side"), covariates=("walking_speed_m_s",))
    return run_study(folder, folder.parent / f"out{levels}", figures=False, plan=plan)


def planted_rows(study: Study) -> list[tuple[str, str, str]]:
    """Rows: pair of conditions, regions with a found difference, and those whose difference depends on the side."""
    rows = []
    for comparison in study.comparisons:
        if comparison.factor == "condition":
            names = _found_regions(comparison.effects)
            pair = f"{comparison.a} to {comparison.b}"
            ways = (pair, f"{comparison.b} less {comparison.a}")
            both = next((c for c in study.changes if any(way in c.factor for way in ways)), None)
            rows.append(
                (f"{pair} of {len(comparison.levels)}", names, "" if both is None else _found_regions(both.effects))
            )
    return rows


def _found_regions(effects: Mapping[str, Effect]) -> str:
    known = [key for key, effect in effects.items() if effect.p_all <= 0.05]
    return ", ".join(dict.fromkeys(key.partition(".")[0] if "." in key else "foot" for key in known)) or "none"


class Walk(NamedTuple):
    """Footsteps (n, 101, 75, 40) of a made walk, and the text of their table."""

    stack: NDArray[np.uint8]
    table: str


def walks_of_people() -> list[list[Walk]]:
    """Some walks of each of some people."""
    out = []
    for person in range(_WALKERS):
        random = seeded(f"walker {person}")
        who = replace(walker(random), sole=1.0)
        walks = [made_walk(who, 420, random)[:_STEPS_OF_WALK] for _ in range(_WALKS)]
        shown = [[upright(step) for step in steps] for steps in walks]
        out.append(
            [
                Walk(np.array([stack for stack, _ in own]), metadata_of(steps, [turn for _, turn in own], 1, "C", "W1"))
                for steps, own in zip(walks, shown, strict=True)
            ]
        )
    return out


def whole_draw(people: Sequence[Sequence[Walk]], seed: int, folder: Path) -> list[bool]:
    """Whether a study of files, through the command, reports a difference in measures, curves and maps."""
    random = seeded(f"whole draw {seed}")
    for person, who in enumerate(random.choice(len(people), PEOPLE, replace=False).tolist(), 1):
        load = random.normal(1.0, 0.12)
        trials = random.choice(len(people[who]), 2 * TRIALS, replace=False).tolist()
        for condition in ("hard", "soft"):
            of_condition = load * random.normal(1.0, 0.04)
            for trial in range(TRIALS):
                walk = people[who][trials.pop()]
                of_steps = of_condition * random.normal(1.0, 0.03) * random.normal(1.0, 0.04, len(walk.stack))
                target = folder / "set" / f"{person:03}" / condition / f"W{trial}"
                target.mkdir(parents=True)
                pressure = np.clip(np.rint(walk.stack * of_steps[:, None, None, None]), 0, 255).astype(np.uint8)
                np.savez(target / "pipeline_1.npz", pressure)
                (target / "metadata.csv").write_text(walk.table.replace("\n1,C,", f"\n{person},{condition},"))
    command = [sys.executable, "-m", "plantar", "analyze", str(folder / "set"), "-o", str(folder / "out")]
    subprocess.run([*command, "--no-figures", "--covariate", "walking_speed_m_s"], check=True, capture_output=True)
    with (folder / "out" / "comparison.csv").open(newline="") as stream:
        measures = any(float(row["p_all"]) <= 0.05 for row in csv.DictReader(stream))
    (comparison,) = json.loads((folder / "out" / "study.json").read_text())["comparisons"]
    return [measures, *(any(c["p"] <= 0.05 for c in comparison[kind]["clusters"]) for kind in ("curve", "map"))]


def whole_draws() -> dict[str, object]:
    """Row of whole draws."""
    people = walks_of_people()
    counts = np.zeros(len(_KINDS), dtype=int)
    for seed in range(WHOLE_DRAWS):
        with TemporaryDirectory() as name:
            counts += whole_draw(people, seed, Path(name))
        print(f"whole draw {seed + 1}: {counts.tolist()}", file=sys.stderr, flush=True)
    found = " ".join(map(str, counts.tolist()))
    return {"part": "whole", "what": "files through the command", "draws": WHOLE_DRAWS, "found": found}


def seeded(name: str) -> np.random.Generator:
    return np.random.default_rng(list(hashlib.sha256(name.encode()).digest()))


def counted(number: int) -> dict[str, object]:
    """Row of a design by its number: draws, and those in which a difference was found."""
    name, design = list(DESIGNS.items())[number - 1]
    counts = np.zeros(len(_KINDS), dtype=int)
    for seed in range(DRAWS):
        counts += design(seeded(f"{name}, draw {seed}"))
    return {"part": str(number), "what": name, "draws": DRAWS, "found": " ".join(map(str, counts.tolist()))}


def write_page(rows: list[dict[str, str]]) -> None:
    """Write the page of all parts."""
    designs = [row for row in rows if row["part"] not in ("effect", "whole")]
    effects = [row["found"].split(" | ") for row in rows if row["part"] == "effect"]
    lines = []
    sums = np.zeros((3, 2), dtype=int)
    for row in designs:
        counts = [int(word) for word in row["found"].split()]
        draws = int(row["draws"])
        for kind, count in enumerate(counts):
            sums[kind] += count, draws
        shown = [f"{count} ({100.0 * count / draws:.1f} %)" for count in counts]
        lines.append((row["what"], draws, *shown, *["-"] * (3 - len(shown))))
    totals = [f"{count} of {draws} ({100.0 * count / max(1, draws):.2f} %)" for count, draws in sums.tolist()]
    whole = [(row["draws"], *row["found"].split()) for row in rows if row["part"] == "whole"]
    lines.append(("all", sum(int(row["draws"]) for row in designs), *totals))
    text = [
        "# Studies of eight designs, without and with a difference",
        "",
        f"Written by `python benchmarks/study_designs.py 1 2 3 4 5 6 7 8 effect whole`, {made_on()}; {PEOPLE} people",
        f"(a group), {PERMUTATIONS} permutations.",
        "",
        f"Draws without a difference in which one was reported: in measures (p of all of {MEASURES}), curves and maps",
        "(clusters). Of 2,000 draws with 5 % found 3.6 to 6.4 % are within three standard deviations.",
        "",
        markdown_table(("design", "draws", "measures", "curves (1D)", "maps (2D)"), lines),
        "",
        *(
            f"Of {draws} whole studies, from files through the command, {PEOPLE} people and {TRIALS} trials in\n"
            f"each of two conditions, speed allowed for: {measures} in measures, {curves} in curves, {maps} in maps.\n"
            for draws, measures, curves, maps in whole
        ),
        f"Studies of made footsteps, {PEOPLE} people and {TRIALS} trials: the last condition takes "
        f"{100 * (1 - _LEFT_HEEL):.0f} % off the pressure under the left heel and is walked faster; speed is allowed",
        "for. Times of contact change with the pace, too. Where a difference was found (p of all), and where it",
        "depends on the side:",
        "",
        markdown_table(("conditions", "differs in", "depends on the side in"), effects),
        "",
    ]
    (FOLDER / "study_designs.md").write_text("\n".join(text), encoding="utf-8")


def main() -> None:
    table = FOLDER / "study_designs.csv"
    for part in sys.argv[1:]:
        if part == "effect":
            with TemporaryDirectory() as name:
                found_rows = [r for n in (2, 4) for r in planted_rows(planted(Path(name) / f"set{n}", n))]
            new = [{"part": part, "what": r[0], "draws": 1, "found": " | ".join(r)} for r in found_rows]
        elif part == "whole":
            new = [whole_draws()]
        else:
            new = [counted(int(part))]
        print(new, flush=True)
        held = list(csv.DictReader(table.open(newline=""))) if table.exists() else []
        kept = [row for row in held if row["part"] != part] + [{k: str(v) for k, v in row.items()} for row in new]
        kept.sort(key=lambda row: row["part"])
        write_rows(table, kept)
        write_page(kept)


if __name__ == "__main__":
    main()
