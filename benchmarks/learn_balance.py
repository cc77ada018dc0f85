"""Learn to balance on a tilting board by the cross-entropy method, with and without plantar skin.

    python benchmarks/learn_balance.py

Both arms observe the same IMU and joints; the second one the centre of pressure and the soles' loads, too. A linear
policy moves hips and ankles, the same on both sides: those of pitch by the features of pitch, those of roll by those of
roll, each divided by how far it goes without a policy. Each arm is trained with five seeds and tested on 16 episodes.
"""

import argparse
import multiprocessing
import time
from pathlib import Path

import numpy as np

from plantar.bench.tables import markdown_table
from plantar.sim.environments.walker import PlantarEnv

DIFFICULTY = 1.0  # the board tilts by up to 5 degrees
STEPS = 200  # of 20 ms
SEEDS, GENERATIONS, POPULATION, ELITE, TESTS = 5, 12, 14, 4, 16
SPREAD = 0.01  # of the first generation's gains on features of spread 1, for both arms
GROUPS = ("hip_pitch", "ankle_pitch", "hip_roll", "ankle_roll")  # joints that move together: two a plane


class Learner:
    """An environment, its features of each plane, and a linear policy that moves a plane's joints by its features."""

    def __init__(self, skin: bool) -> None:
        self.env, self.skin = PlantarEnv("board", difficulty=DIFFICULTY, skin=skin), skin
        names = [n for side in ("left", "right") for n in self.env.robot.legs[side].joints]
        self.groups = np.array([[float(word in name) for name in names] for word in GROUPS])
        if not self.groups.any(axis=1).all():
            raise SystemExit(f"joints {', '.join(names)} lack one of {', '.join(GROUPS)}")
        self.places = {s: self.env.robot.layouts[s].positions[:, :2] for s in ("left", "right")}
        self.pitch, self.scale = 6 if skin else 5, np.ones(13 if skin else 10)  # features of pitch, and all
        seen = [self.features(self.env.reset(seed=10**7)[0])]
        for _ in range(100):  # how far each goes without a policy
            seen.append(self.features(self.env.step(np.zeros(len(names)))[0]))
        self.scale = np.std(seen, axis=0) + 1e-6
        self.size = 2 * len(self.scale)

    def features(self, seen: dict[str, np.ndarray]) -> np.ndarray:
        """Of pitch, then of roll: tilt, turn, two angles and a speed; with skin CoP and difference of loads."""
        k = len(seen["joints"]) // 2
        moved = self.groups @ seen["joints"].reshape(2, k).T / self.groups.sum(axis=1)[:, None]
        planes = [[seen["imu"][6], seen["imu"][1], *moved[:2, 0], moved[1, 1]]]
        planes += [[seen["imu"][7], seen["imu"][0], *moved[2:, 0], moved[3, 1]]]
        if self.skin:
            forces = [seen[f"skin_{side}"] for side in ("left", "right")]
            cop = sum(f @ self.places[s] for f, s in zip(forces, ("left", "right"), strict=True))
            planes[0] += [cop[0]]
            planes[1] += [cop[1], forces[0].sum() - forces[1].sum()]
        return np.concatenate(planes) / self.scale

    def episode(self, weights: np.ndarray, seed: int) -> float:
        seen, _ = self.env.reset(seed=seed)
        cut, total = 2 * self.pitch, 0.0
        gains = weights[:cut].reshape(2, -1), weights[cut:].reshape(2, -1)
        rest = self.features(seen)  # the sensors are zeroed while the board is level
        for _ in range(STEPS):
            moved = self.features(seen) - rest
            action = np.concatenate([gains[0] @ moved[: self.pitch], gains[1] @ moved[self.pitch :]]) @ self.groups
            seen, reward, fell, _, _ = self.env.step(action)
            total += reward
            if fell:
                break
        return total


def train(given: tuple[bool, int]) -> tuple[float, float, float]:
    """Mean return before and after training of one arm and seed, and its processor time in s."""
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
    after = np.mean([learner.episode(mean, int(e)) for e in tests])
    return float(before), float(after), time.process_time()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_suffix(".md"))
    parser.add_argument("--seeds", type=int, default=SEEDS)
    options = parser.parse_args()
    jobs = [(skin, seed) for seed in range(options.seeds) for skin in (False, True)]
    with multiprocessing.get_context("spawn").Pool(2, maxtasksperchild=1) as pool:
        found = dict(zip(jobs, pool.map(train, jobs, chunksize=1), strict=True))
    spent = sum(seconds for *_, seconds in found.values())
    lines = ["# A linear policy on a tilting board", "", "Made by `python benchmarks/learn_balance.py`.", ""]
    lines += [
        f"Return of {STEPS} steps (at most {STEPS}), mean of {TESTS} test episodes; {options.seeds} seeds of training, "
        f"{GENERATIONS} generations of {POPULATION}; {spent:.0f} s of processor time.",
        "",
    ]
    rows = []
    for skin in (False, True):
        before, after, _ = np.array([found[skin, seed] for seed in range(options.seeds)]).T
        rng = np.random.default_rng(0)
        means = rng.choice(after, (10_000, len(after))).mean(axis=1)
        low, high = np.percentile(means, [2.5, 97.5])
        name = "IMU, joints, skin" if skin else "IMU, joints"
        each = ", ".join(f"{value:.1f}" for value in after)
        rows.append((name, f"{before.mean():.1f}", f"{after.mean():.1f}", f"{low:.1f} to {high:.1f}", each))
    lines.append(markdown_table(("observed", "before", "after, mean of seeds", "95 % interval", "each seed"), rows))
    text = "\n".join(lines) + "\n"
    options.output.write_text(text)
    print(text)


if __name__ == "__main__":
    main()
