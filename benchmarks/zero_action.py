"""How many episodes of each task the action 0 survives: a task is real where that fails most of them.

    python benchmarks/zero_action.py                     both robots, 30 seeds
    python benchmarks/zero_action.py --robots h1 --seeds 10

Difficulty is swept by factors of 2 about 1, which is what a task has by default; all rows are shown. An episode is
survived where it neither falls nor fails its task in 500 steps, 10 s. Intervals are Wilson's at 95 %.
"""

import argparse
import subprocess
from pathlib import Path

import gymnasium
import numpy as np

import plantar.sim.environments  # noqa: F401  registers the tasks
from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import markdown_table

TASKS = ("Stand", "Step", "Walk", "Board")
SWEEP = (0.25, 0.5, 1.0, 2.0)
PAGE = """# The action 0 in each task

`python benchmarks/zero_action.py`, {seeds} seeds, commit {commit}. At a difficulty of 1, the default, the action 0
fails most episodes of each task; a policy is compared with these rows first.

"""
ROOT = Path(__file__).resolve().parents[1]


def survived(task: str, robot: str, difficulty: float, seeds: int) -> tuple[int, float]:
    """Episodes that the action 0 survives, and the median of their steps."""
    env = gymnasium.make(f"Plantar{task}-v0", robot=robot, difficulty=difficulty)
    zero = np.zeros(env.action_space.shape, dtype=np.float32)
    lengths = []
    whole = 0
    for seed in range(seeds):
        env.reset(seed=seed)
        steps = 0
        ended = truncated = False
        while not (ended or truncated):
            _, _, ended, truncated, _ = env.step(zero)
            steps += 1
        whole += not ended
        lengths.append(steps)
    return whole, float(np.median(lengths))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", nargs="+", default=["h1", "hrp2kai"])
    parser.add_argument("--seeds", type=int, default=30)
    parser.add_argument("--output", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    rows = []
    for task in TASKS:
        for robot in options.robots:
            for difficulty in SWEEP:
                whole, steps = survived(task, robot, difficulty, options.seeds)
                low, high = (round(100 * x) for x in wilson_interval(whole, options.seeds))
                rows.append(
                    [task, robot, f"{difficulty:g}", f"{whole}/{options.seeds}", f"{low} to {high} %", f"{steps:g}"]
                )
                print(*rows[-1], flush=True)
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=ROOT).stdout
    head = ["task", "robot", "difficulty", "survived", "95 %", "median steps"]
    options.output.write_text(PAGE.format(seeds=options.seeds, commit=commit.strip()) + markdown_table(head, rows))


if __name__ == "__main__":
    main()
