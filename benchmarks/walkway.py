"""Footsteps of walkways in StepUP-P150's form: processor time, memory, feet, workers and kills.

python benchmarks/walkway.py [STEPS]      (writes benchmarks/walkway.md; 20,000 footsteps take 8 min of processor time)

The footsteps are made (`made_walkway.py`): stacks of some people, each copied until there are 20,000 footsteps;
walkways of 90 s as they are published; and passes whose feet are known, found without the table.
"""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from made_walkway import MadeStep, made_walk, metadata_of, trial_of, upright, walker, write_stack
from numpy.typing import NDArray

from plantar.bench.tables import made_on, markdown_table
from plantar.formats.format import ReadOptions
from plantar.formats.walkway import PITCH
from plantar.formats.walkway_passes import WalkwayPass
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.study.one_recording import GRID
from plantar.gait.analysis.walkway.measured_walkway import measure_walkway
from plantar.gait.analysis.walkway.walkway_steps import steps_of_pass
from plantar.layouts.cell_grid import CellGrid

FOLDER = Path(__file__).parent
STEPS = 20_000
FRAMES = 9060
PEOPLE = 24
"""People whose stacks are made; the others are copies."""

WALKS = 2
PASSES_OF = 40
"""Walkways that are measured, and people whose feet are found without the table."""


def write_set(folder: Path, steps: int) -> int:
    """Write stacks of as many footsteps; returns their number."""
    count = 0
    made: list[tuple[Path, int]] = []
    number = 0
    while count < steps:
        number += 1
        target = folder / f"{number:03}" / ("BF", "ST")[number % 2] / "W1"
        if number <= PEOPLE:
            random = np.random.default_rng(number)
            own = made_walk(walker(random), FRAMES, random)
            write_stack(target, own, number, target.parent.name, "W1")
            made.append((target, len(own)))
            count += len(own)
            continue
        source, held = made[number % len(made)]
        target.mkdir(parents=True)
        os.link(source / "pipeline_1.npz", target / "pipeline_1.npz")
        rows = (source / "metadata.csv").read_text().splitlines()
        text = [rows[0], *(",".join([str(number), target.parent.name, *row.split(",")[2:]]) for row in rows[1:])]
        (target / "metadata.csv").write_text("\n".join(text))
        count += held
    return count


def measured(folder: Path, out: Path, jobs: int) -> tuple[float, float, float]:
    """Processor time in s of a study with all its processes, its time by the clock, and the largest memory in MB."""
    code = (
        "import re, resource, sys; from pathlib import Path;"
        "from plantar.gait.analysis.study.run_study import run_study;"
        "from plantar.gait.analysis.study.study_options import StudyOptions;"
        "run_study(sys.argv[1], sys.argv[2], figures=False, plan=StudyOptions(jobs=int(sys.argv[3])));"
        "used = [[u.ru_utime + u.ru_stime, u.ru_maxrss / 1e3] for u in map(resource.getrusage, "
        "(resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))];"
        # ru_maxrss of a process includes what the one that started it held.
        "used[0][1] = int(re.search('VmHWM:.*?([0-9]+)', Path('/proc/self/status').read_text())[1]) / 1e3;"
        "print(used)"
    )
    begun = time.perf_counter()
    command = [sys.executable, "-c", f"if __name__ == '__main__': {code}", str(folder), str(out), str(jobs)]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    own, children = json.loads(text)
    return own[0] + children[0], time.perf_counter() - begun, max(own[1], children[1])


def inflating(folder: Path) -> float:
    """Processor time in ms a footstep of numpy.load of every tenth stack: what this machine does at this hour."""
    count = 0
    begun = time.process_time()
    for path in sorted(folder.rglob("*.npz"))[::10]:
        count += len(_inflated(path))
    return 1e3 * (time.process_time() - begun) / count


def killed(folder: Path, out: Path, whole: Path) -> tuple[int, int, bool]:
    """Kills of a study, recordings that were kept at the last one, and whether its table is that of a whole run."""
    kills = 0
    for kept in (3, 9):
        command = [sys.executable, "-m", "plantar", "analyze", str(folder)]
        command += ["--no-figures", "-o", str(out), "--jobs", "2"]
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        while not out.exists() or len(list((out / "measured").glob("*.npz"))) < kept:
            time.sleep(0.01)
        os.killpg(run.pid, signal.SIGKILL)
        run.wait()
        kills += 1
    held = len([p for p in (out / "measured").glob("*.npz") if not p.name.startswith(".")])
    measured(folder, out, 1)
    return kills, held, (out / "steps.csv").read_bytes() == (whole / "steps.csv").read_bytes()


def walk_rows(folder: Path) -> list[tuple[object, ...]]:
    """Rows of walkways: processor time of inflating by numpy, and of measuring with and without the table."""
    rows: list[tuple[object, ...]] = []
    for number in range(WALKS):
        random = np.random.default_rng(100 + number)
        steps = made_walk(walker(random), FRAMES, random)
        path = folder / f"walk{number}" / "trial.npz"
        path.parent.mkdir()
        np.savez_compressed(path, trial_of(steps, FRAMES))
        measure = partial(measure_walkway, path, ReadOptions(), AnalysisOptions(), GRID)
        times = [_spent(partial(_inflated, path)), _spent(measure)]
        turns = [upright(step)[1] for step in steps]
        (path.parent / "metadata.csv").write_text(metadata_of(steps, turns, number, "BF", "W1"))
        times.append(_spent(measure))
        rows.append((len(steps), *times, times[1] / times[0], times[2] / times[0]))
        path.unlink()
    return rows


def _inflated(path: Path) -> NDArray[np.uint8]:
    values: NDArray[np.uint8] = np.load(path)["arr_0"]
    return values


def _spent(work: Callable[[], object]) -> float:
    begun = time.process_time()
    work()
    return time.process_time() - begun


def sides(people: int) -> tuple[int, int]:
    """Footsteps, and those whose foot is found as it was made, without the table."""
    right = 0
    count = 0
    for number in range(people):
        random = np.random.default_rng(1000 + number)
        steps = made_walk(walker(random), FRAMES, random)
        for walk in range(steps[-1].walk + 1):
            own = [step for step in steps if step.walk == walk]
            found = steps_of_pass(_pass_of(own), walk, 100.0, [])
            count += len(own)
            right += sum(f.side == s.side for f, s in zip(found, own, strict=False)) if len(found) == len(own) else 0
    return count, right


def _pass_of(steps: Sequence[MadeStep]) -> WalkwayPass:
    first = min(step.begin for step in steps)
    frames = max(step.begin + len(step.frames) for step in steps) - first
    load: dict[tuple[int, int], int] = {}
    parts = []
    for step in steps:
        row, column = np.nonzero(step.frames.any(axis=0))
        places = list(zip((row + step.row).tolist(), (column + step.column).tolist(), strict=True))
        index = [load.setdefault(place, len(load)) for place in places]
        parts.append((step, index, step.frames[:, row, column]))
    force = np.zeros((frames, len(load)))
    for step, index, values in parts:
        force[step.begin - first : step.begin - first + len(values), index] += values * 1e3 * PITCH**2
    row, column = np.array(list(load)).T
    return WalkwayPass(first, CellGrid(row, column), force, (720, 240))


class Found(NamedTuple):
    """Figures of the page: feet found of so many; rows of walkways; footsteps, and what one and two processes take."""

    feet: tuple[int, int]
    walks: list[tuple[object, ...]]
    total: int
    one: tuple[float, float, float]
    two: tuple[float, float, float]
    inflate: tuple[float, float]
    rows: int
    different: int
    same: bool
    kills: tuple[int, int, bool]


def found(steps: int) -> Found:
    """Measure all, with so many footsteps in stacks."""
    with TemporaryDirectory() as name:
        root = Path(name)
        feet = sides(PASSES_OF)
        walks = walk_rows(root)
        total = write_set(root / "set", steps)
        runs = [(measured(root / "set", root / str(jobs), jobs), inflating(root / "set")) for jobs in (1, 2)]
        (one, two), inflate = zip(*runs, strict=True)
        tables = [(root / jobs / "steps.csv").read_bytes() for jobs in ("1", "2")]
        with (root / "2" / "steps.csv").open() as stream:
            rows = [(r["recording"], r["side"], r["step"]) for r in csv.DictReader(stream)]
        for path in sorted((root / "set").iterdir())[:12]:
            shutil.copytree(path, root / "small" / path.name)
        measured(root / "small", root / "whole", 1)
        kills = killed(root / "small", root / "killed", root / "whole")
        return Found(feet, walks, total, one, two, inflate, len(rows), len(set(rows)), tables[0] == tables[1], kills)


def page_of(f: Found, load: float) -> str:
    """Page of the figures; `load`: that of the machine."""
    count, right = f.feet
    kills, held, again = f.kills
    runs = ((1, f.one, f.inflate[0]), (2, f.two, f.inflate[1]))
    spent = [(f.total, n, 1e3 * own[0] / f.total, inflate, *own[1:]) for n, own, inflate in runs]
    lines = [
        "# Footsteps of walkways, of any number",
        "",
        f"Made footsteps in StepUP-P150's form; written by `python benchmarks/walkway.py`, {made_on()}.",
        f"Load of the machine: {load:.1f} on {os.cpu_count()} cores.",
        "",
        "Stacks (`pipeline_1.npz`, bytes) as a study without figures, loading of libraries included:",
        "",
        markdown_table(
            (
                "footsteps",
                "processes",
                "processor time, ms a footstep",
                "of numpy.load alone",
                "clock, s",
                "largest memory of a process, MB",
            ),
            spent,
        ),
        "",
        f"Rows of steps.csv: {f.rows}, different ones: {f.different}; with one and two processes the same: {f.same}.",
        f"Killed {kills} times with {held} of 12 recordings kept, a study went on to the same bytes: {again}.",
        "",
        "Walkways (`trial.npz`, 9060 x 720 x 240 bytes), processor time in s:",
        "",
        markdown_table(
            ("footsteps", "numpy.load", "measured, feet found", "measured, feet by metadata.csv", "ratio", "ratio"),
            f.walks,
        ),
        "",
        f"Feet found without the table: {right} of {count} ({100.0 * right / count:.2f} %).",
        "",
    ]
    return "\n".join(lines)


def main() -> None:
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else STEPS
    (FOLDER / "walkway.md").write_text(page_of(found(steps), os.getloadavg()[0]), encoding="utf-8")


if __name__ == "__main__":
    main()
