"""Does a sole help a learner? A residual on the controller that knows net forces alone, on stones it falls off.

    python benchmarks/sole_residual.py               what is missing of 3 seeds of each sensing, then the page
    python benchmarks/sole_residual.py --runs 200    with a larger budget, in rows of their own

The controller (`net-force` of `plantar bench footholds`) takes every stone for a whole sole. The residual turns the
ankles of a loaded foot by up to 0.1 rad, linearly in what it senses: the trunk's rate of turn and a constant
("nothing"); besides, the sole's load ("net force"); besides that, place of the load and share of the cells that carry
("taxels"). Each is found by the same number of runs of a hill climb: a step of the best so far, kept where it takes
more steps, or stays up longer at as many, each on one ground for all. What is found, and no residual, then walk fresh
grounds. Intervals are Student's, over the seeds of the search.
"""

import argparse
import csv
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t

from plantar.bench.tables import markdown_table
from plantar.sim.bench.footholds.foothold_run import TRIALS, run_trial
from plantar.sim.bench.footholds.policy import Action, ByNetForce

ROOT = Path(__file__).resolve().parents[1]
TRIAL = next(trial for trial in TRIALS if (trial.kind, trial.value) == ("stones", 0.4))
SIZES = {"nothing": 3, "net force": 5, "taxels": 10}
LARGEST = 0.1  # rad
COLUMNS = ("sensing", "seed", "runs", "parameters", "steps", "completed", "tested")
PAGE = """# Does a sole help a learner?

`python benchmarks/sole_residual.py --runs {runs}`, commit {commit}: a residual on the controller by net force alone,
on stones of 40 to 60 % of a sole (h1), found in {runs} runs each; {tested} fresh grounds a seed. Its `--help` has the
method. Without a residual {base} % of the steps are taken on these grounds. A budget of {runs} runs is small: where a
row is that of no residual, its search found nothing better on its own ground.

"""


class Residual(ByNetForce):
    """The controller by net force, with a residual at the ankles."""

    def __init__(self, task: Any, sensing: str, gains: NDArray[np.float64]) -> None:
        super().__init__(task)
        self._gains = gains
        self._sensing = sensing
        self._weight = task.weight
        self._layouts = self._walker.robot.layouts
        self._ankles = [
            [next(i for i, name in enumerate(task.joints) if side in name and part in name) for part in parts]
            for side, parts in (("left", ("ankle_pitch", "ankle_roll")), ("right", ("ankle_pitch", "ankle_roll")))
        ]

    def step(self, sensors: Any) -> Action:
        action = super().step(sensors)
        angles = np.array(action.angles)
        for (pitch, roll), side in zip(self._ankles, ("left", "right"), strict=True):
            force = np.nan_to_num(sensors.readings[side].force)
            load = float(force.sum()) / self._weight
            if load < 0.05:
                continue
            mirror = 1.0 if side == "left" else -1.0
            seen = np.zeros((2, SIZES["taxels"]))
            seen[0, :2] = sensors.gyro[1], 1.0
            seen[1, 2] = mirror * sensors.gyro[0]
            seen[0, 3] = seen[1, 4] = load
            places = self._layouts[side].positions[:, :2]
            half = 0.5 * np.ptp(places, axis=0)
            cop = (force @ places / force.sum() - places.mean(axis=0)) / half
            share = float((force > 0.02 * force.sum()).mean())
            seen[0, 5:7] = cop[0], share
            seen[1, 7] = mirror * cop[1]
            seen[0, 8], seen[1, 9] = abs(cop[1]), mirror * cop[1] * share
            turned = LARGEST * np.tanh(seen[:, : len(self._gains)] @ self._gains)
            angles[pitch] += turned[0]
            angles[roll] += mirror * turned[1]
        return Action(angles, action.torques, action.moved)


def walked(sensing: str, gains: NDArray[np.float64], seed: int) -> tuple[int, float, bool]:
    """Steps taken, time in s, and whether it was completed."""
    found = run_trial(lambda task: Residual(task, sensing, gains), TRIAL, "h1", seed)
    return found.steps, found.time, found.completed


def searched(sensing: str, seed: int, runs: int) -> NDArray[np.float64]:
    """The gains that a hill climb finds in so many runs."""
    rng = np.random.default_rng([seed, SIZES[sensing]])
    best = np.zeros(SIZES[sensing])
    ground = 1000 + seed
    score = walked(sensing, best, ground)[:2]
    for _ in range(runs - 1):
        tried = best + 0.5 * rng.standard_normal(len(best))
        reached = walked(sensing, tried, ground)[:2]
        if reached >= score:
            best, score = tried, reached
    return best


def page(rows: list[dict[str, str]], runs: int) -> str:
    """The page of all rows of a budget."""
    mine = [row for row in rows if int(row["runs"]) in (0, runs)]
    lines = []
    base = ""
    for sensing in ("none", *SIZES):
        own = [row for row in mine if row["sensing"] == sensing]
        if not own:
            continue
        shares = [100.0 * float(row["steps"]) for row in own]
        tested = sum(int(row["tested"]) for row in own)
        mean = float(np.mean(shares))
        if sensing == "none":
            base = f"{mean:.0f}"
        wide = (
            float(t.ppf(0.975, len(own) - 1) * np.std(shares, ddof=1) / np.sqrt(len(own))) if len(own) > 1 else np.nan
        )
        done = sum(int(row["completed"]) for row in own)
        each = ", ".join(f"{share:.0f}" for share in shares)
        lines.append((sensing, str(len(own)), f"{mean:.0f} ± {wide:.0f} %", each, f"{done}/{tested}"))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=ROOT).stdout
    head = ["sensed by the residual", "seeds", "steps taken, mean and 95 %", "of each seed", "completed"]
    text = PAGE.format(commit=commit.strip(), runs=runs, tested=mine[0]["tested"], base=base)
    return text + markdown_table(head, lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--rows", type=Path, default=Path(__file__).with_suffix(".csv"), help="goes on where it was left"
    )
    parser.add_argument("--runs", type=int, default=6, help="of each search (6)")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--tests", type=int, default=3, help="fresh grounds a seed (3)")
    parser.add_argument("--output", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    rows = list(csv.DictReader(options.rows.open())) if options.rows.exists() else []
    known = {(row["sensing"], int(row["seed"]), int(row["runs"])) for row in rows}
    for seed in range(options.seeds):
        for sensing in ("none", *SIZES):
            runs = 0 if sensing == "none" else options.runs
            if (sensing, seed, runs) in known:
                continue
            gains = np.zeros(0) if sensing == "none" else searched(sensing, seed, runs)
            tests = [walked(sensing, gains, 100 * seed + k) for k in range(options.tests)]
            steps = float(np.mean([one[0] / 8 for one in tests]))
            done = sum(one[2] for one in tests)
            values = (sensing, seed, runs, " ".join(f"{g:.3f}" for g in gains), f"{steps:.4f}", done, options.tests)
            rows.append(dict(zip(COLUMNS, map(str, values), strict=True)))
            with options.rows.open("w", newline="") as stream:
                writer = csv.DictWriter(stream, COLUMNS)
                writer.writeheader()
                writer.writerows(rows)
            print(*values, flush=True)
    options.output.write_text(page(rows, options.runs))


if __name__ == "__main__":
    main()
