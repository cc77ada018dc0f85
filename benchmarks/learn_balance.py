"""Learn to balance on a tilting board by the cross-entropy method, with and without plantar skin.

    python benchmarks/learn_balance.py

Both arms observe the same IMU and joints; the second one the load and the center of pressure of each sole, too. A
linear policy moves ankles and hips, the same on both sides. Each arm is trained with five seeds and tested on 16 new
episodes, in 5 minutes on 2 cores.
"""

import argparse
import multiprocessing
import time
from pathlib import Path

import numpy as np

from plantar.sim.environments.walker import PlantarEnv

DIFFICULTY = 1.0  # the board tilts by up to 5 degrees
STEPS = 200  # of 20 ms
SEEDS, GENERATIONS, POPULATION, ELITE, TESTS = 5, 7, 12, 3, 16
SPREAD = 0.06  # of the first generation's gains, for both arms
GROUPS = {"hip_roll": 0, "hip_pitch": 1, "ankle_pitch": 2, "ankle_roll": 3}  # joints that move together


class Learner:
    """An environment, its features, and a linear policy of them."""

    def __init__(self, skin: bool) -> None:
        self.env, self.skin = PlantarEnv("board", difficulty=DIFFICULTY, skin=skin), skin
        names = [n for side in ("left", "right") for n in self.env.robot.legs[side].joints]
        self.groups = np.zeros((4, len(names)))
        for k, name in enumerate(names):
            for word, group in GROUPS.items():
                self.groups[group, k] = float(word in name)
        if not self.groups.any(axis=1).all():
            raise SystemExit(f"joints {', '.join(names)} lack one of {', '.join(GROUPS)}")
        self.places = {s: self.env.robot.layouts[s].positions[:, :2] for s in ("left", "right")}
        self.size = 4 * (14 if skin else 8)

    def features(self, seen: dict[str, np.ndarray]) -> np.ndarray:
        """Tilt and turn of the torso, means of the joints that move together; load and CoP of each sole."""
        k = len(seen["joints"]) // 2
        angles = self.groups @ seen["joints"][:k] / self.groups.sum(axis=1)
        found = [seen["imu"][6:8], 0.2 * seen["imu"][:2], angles]
        for side in ("left", "right") if self.skin else ():
            force = seen[f"skin_{side}"]
            load = force.sum()
            cop = force @ self.places[side] / load if load > 0.01 else np.zeros(2)
            found.append([load - 0.5, *(cop / 0.1 * load)])
        return np.concatenate(found)

    def episode(self, weights: np.ndarray, seed: int) -> float:
        seen, _ = self.env.reset(seed=seed)
        gains, total = weights.reshape(4, -1), 0.0
        rest = self.features(seen)  # the sensors are zeroed while the board is level
        for _ in range(STEPS):
            action = (gains @ (self.features(seen) - rest)) @ self.groups
            seen, reward, fell, _, _ = self.env.step(action)
            total += reward
            if fell:
                break
        return total


def train(given: tuple[bool, int]) -> tuple[float, float]:
    """Mean return before and after training of one arm and seed."""
    skin, seed = given
    learner, rng = Learner(skin), np.random.default_rng(seed)
    mean, spread = np.zeros(learner.size), np.full(learner.size, SPREAD)
    for generation in range(GENERATIONS):
        tried = mean + spread * rng.standard_normal((POPULATION, learner.size))
        tried[0] = mean
        episodes = 10_000 * seed + 2 * generation + np.arange(2)
        returns = [np.mean([learner.episode(w, int(e)) for e in episodes]) for w in tried]
        best = tried[np.argsort(returns)[-ELITE:]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 0.1 * SPREAD
    tests = 10**6 + np.arange(TESTS)
    before = np.mean([learner.episode(0.0 * mean, int(e)) for e in tests])
    return float(before), float(np.mean([learner.episode(mean, int(e)) for e in tests]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".md"))
    parser.add_argument("--seeds", type=int, default=SEEDS)
    options = parser.parse_args()
    began = time.perf_counter()
    jobs = [(skin, seed) for seed in range(options.seeds) for skin in (False, True)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        found = dict(zip(jobs, pool.map(train, jobs, chunksize=1), strict=True))
    lines = ["# A linear policy on a tilting board", "", "Made by `python benchmarks/learn_balance.py`.", ""]
    lines += [
        f"Return of {STEPS} steps (at most {STEPS}), mean of {TESTS} test episodes; {options.seeds} seeds of training, "
        f"{GENERATIONS} generations of {POPULATION}; {time.perf_counter() - began:.0f} s.",
        "",
        "| observed | before | after, mean of seeds | 95 % interval | each seed |",
        "|---|---|---|---|---|",
    ]
    for skin in (False, True):
        before, after = np.array([found[skin, seed] for seed in range(options.seeds)]).T
        rng = np.random.default_rng(0)
        means = rng.choice(after, (10_000, len(after))).mean(axis=1)
        low, high = np.percentile(means, [2.5, 97.5])
        name = "IMU, joints, skin" if skin else "IMU, joints"
        each = ", ".join(f"{value:.1f}" for value in after)
        lines.append(f"| {name} | {before.mean():.1f} | {after.mean():.1f} | {low:.1f} to {high:.1f} | {each} |")
    text = "\n".join(lines) + "\n"
    options.output.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
