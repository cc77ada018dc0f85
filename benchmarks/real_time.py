"""What a walk costs beside its physics: `python benchmarks/real_time.py [--runs N] [--against FOLDER [--pairs N]]`.

Each scene is run and timed by its processor time, and its motion is repeated by `mj_step` in a loop: "scene over bare
step" is the first over the second, "tick" the processor time of what a robot's computer does every 5 ms, with servos.
Scenes take turns, so that a slow minute of the machine meets each once. With a checkout of another commit, its kernels
compiled, both run in turn, in processes of their own, and the ratios of their processor times are written, too. Exact
on any machine are the calls of a tick: `tests/sim/calls_a_tick.py`.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

FOLDER = Path(__file__).parent
# scene, robot, settings: the longer ones shortened
SCENES = (
    ("flat", "h1", ()),
    ("flat", "hrp2kai", ()),
    ("beam", "h1", ("steps=8",)),
    ("beam", "hrp2kai", ("steps=8",)),
    ("uneven", "h1", ("steps=8",)),
    ("uneven", "hrp2kai", ("steps=8",)),
    ("stones", "h1", ()),
    ("partial-third", "h1", ()),
)
PAIRED = ("flat", "h1", ("steps=8",))


def cost(scene: str, robot: str, settings: tuple[str, ...]) -> dict[str, float]:
    """Processor times of a walk and of its bare physics in s, and of its ticks in us."""
    import mujoco
    import numpy as np

    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    class Kept(Simulation):
        def step_physics(self) -> None:
            controls.append(self.world.data.ctrl.copy())
            super().step_physics()

    def timed(work: Callable[..., Any], adds: bool) -> Callable[..., Any]:
        """Work that keeps its processor time in us, on its own or added to the last one's."""

        def kept(*arguments: Any) -> Any:
            begun = time.thread_time_ns()
            result = work(*arguments)
            used = 1e-3 * (time.thread_time_ns() - begun)
            if adds:
                ticks[-1] += used
            else:
                ticks.append(used)
            return result

        return kept

    controls: list[np.ndarray] = []
    ticks: list[float] = []
    kept = Kept(load_scene(scene, settings, robot), 1)
    model = kept.world.model
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, kept.world.data)
    kept.run()
    simulation = Simulation(load_scene(scene, settings, robot), 1)
    simulation.controller.step = timed(simulation.controller.step, False)  # type: ignore[method-assign]
    simulation.servos.command = timed(simulation.servos.command, True)  # type: ignore[method-assign]
    began = time.process_time()
    out = simulation.run()
    walked = time.process_time() - began
    began = time.process_time()
    for control in controls:
        data.ctrl[:] = control
        mujoco.mj_step(model, data)
    bare = time.process_time() - began
    p50, p99, p999 = np.percentile(ticks, (50.0, 99.0, 99.9))
    return {
        "sim": out["sim_time_s"],
        "walked": walked,
        "bare": bare,
        "p50": p50,
        "p99": p99,
        "p999": p999,
        "most": max(ticks),
    }


def _in_checkout(folder: Path) -> dict[str, float]:
    """Cost of the paired scene by the code of a checkout."""
    environment = {**os.environ, "PYTHONPATH": str(folder.resolve()), "PYTHONWARNINGS": "ignore"}
    command = [sys.executable, __file__, "--one"]
    done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout))


def _commit(folder: Path) -> str:
    """Short name of a checkout's commit."""
    command = ["git", "-C", str(folder), "rev-parse", "--short=8", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def _paired(other: Path, own: Path, pairs: int) -> tuple[str, str]:
    """A row of the ratios of two checkouts: commit and text."""
    ratios = []
    for turn in range(pairs):
        theirs, ours = _in_checkout(other), _in_checkout(own)
        ratios.append(ours["walked"] / theirs["walked"])
        print(f"pair {turn + 1}/{pairs}: {ratios[-1]:.3f}", file=sys.stderr)
    ratios.sort()
    return _commit(other), f"{median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"


def main(runs: int, pairs: int, against: Path | None) -> None:
    from resumable import write_table

    from plantar.bench.tables import markdown_table

    seen: list[list[dict[str, float]]] = [[] for _ in SCENES]
    for turn in range(runs):
        for costs, scene in zip(seen, SCENES, strict=True):
            costs.append(cost(*scene))
            over = costs[-1]["walked"] / costs[-1]["bare"]
            print(f"{turn + 1}/{runs} {' '.join(scene[:2])}: {over:.2f}", file=sys.stderr)
    lines = []
    for costs, (scene, robot, settings) in zip(seen, SCENES, strict=True):
        middle = {name: median(c[name] for c in costs) for name in costs[0]}
        over = median(c["walked"] / c["bare"] for c in costs)
        ticks = (f"{middle[name]:.0f}" for name in ("p50", "p99", "p999", "most"))
        factor = f"{middle['sim'] / middle['walked']:.1f}"
        lines.append((scene, robot, " ".join(settings), factor, f"{over:.2f}", *ticks))
    head = ("scene", "robot", "settings", "real-time factor", "scene over bare step")
    head = (*head, "tick, median [us]", "99 % [us]", "99.9 % [us]", "largest [us]")
    own = FOLDER.parent
    tables = [markdown_table(head, lines), "", f"At commit {_commit(own)}, medians of {runs} run(s)."]
    if against is not None:
        commit, text = _paired(against, own, pairs)
        tables.append("")
        tables.append(f"Processor time of {' '.join(PAIRED[:2])} over that at {commit}: {text}, {pairs} pairs.")
    write_table(FOLDER / "real_time.md", tables)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3, help="runs of each scene (3)")
    parser.add_argument("--against", type=Path, help="checkout of another commit, with compiled kernels")
    parser.add_argument("--pairs", type=int, default=10, help="runs of each checkout (10)")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(cost(*PAIRED)))
    else:
        main(options.runs, options.pairs, options.against)
