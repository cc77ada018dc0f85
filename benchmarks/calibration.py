"""Calibration of soles with known faults: errors of gains and center of pressure, coverage, and the least possible.

    python benchmarks/calibration.py 200 robot          # draws, and which ways of calibrating
    python benchmarks/calibration.py 40 weight scale both common single

Prints rows of `benchmarks/calibration.md`. Each draw has its own faults; a motion serves ten. Errors of the center of
pressure and of a step's impulse are those on another motion than the calibration's, against the cells' own forces.
"""

import sys
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from faulty_soles import GRAVITY, RATE, SIDES, Array, Faults, Motion, Pad, correlated, rolled, stand_and_step

from plantar import load_robot
from plantar.calibration import Take, calibrate
from plantar.layouts.calibration import SoleCalibration

WEIGHT = 86.0 * GRAVITY
SLOW = (0.002, 0.0005)  # of the weight, and m of moment arm of it: noise of joints, IMU and mass while leaning
FAST = (0.015, 0.004)  # and while stepping
KEPT = 0.1  # s for which this noise lasts
EACH = 10  # draws of faults on a motion
LAYOUTS = load_robot("h1").layouts


class Scene(NamedTuple):
    """A motion, with the `forces` (k, n) of each sole's cells."""

    motion: Motion
    forces: Mapping[str, Array]


def scene(seed: int) -> Scene:
    rng = np.random.default_rng(seed)
    motion = stand_and_step(rng, WEIGHT, LAYOUTS)
    return Scene(motion, {s: Pad(LAYOUTS[s], rng).forces(motion.load[s], motion.cop[s]) for s in SIDES})


def known_by_joints(motion: Motion, rng: np.random.Generator) -> tuple[Array, dict[str, Array]]:
    """Load (k,) and each sole's center of pressure (k, 2) while it carries alone, with a robot's noise."""
    size = np.where(motion.slow[:, None], SLOW, FAST) * WEIGHT
    noise = correlated(rng, len(motion.time), KEPT, 5)
    total = motion.load["left"] + motion.load["right"]
    cop = {}
    for i, side in enumerate(SIDES):
        alone = motion.load[side] > 0.999 * total
        off = size[:, 1:] * noise[:, 1 + 2 * i : 3 + 2 * i] / np.maximum(total, 1.0)[:, None]
        cop[side] = np.where(alone[:, None], motion.cop[side] + off, np.nan)
    return total + size[:, 0] * noise[:, 0], cop


def takes(way: str, calibrated: Scene, faults: Mapping[str, Faults], rng: np.random.Generator) -> list[Take]:
    motion = calibrated.motion
    rest = np.arange(100) / RATE
    found = [Take("zero", rest, {s: faults[s].counts(np.zeros((100, len(LAYOUTS[s]))), rng) for s in SIDES})]
    if way in ("robot", "both", "weight"):
        counts = {s: faults[s].counts(calibrated.forces[s], rng) for s in SIDES}
        load, cop = known_by_joints(motion, rng)
        found.append(Take("motion", motion.time, counts, *((WEIGHT,) if way == "weight" else (load, cop))))
    if way in ("scale", "both"):
        for side in SIDES:
            at, forces = rolled(rng, LAYOUTS[side])
            load = forces.sum(axis=1)
            load = load * (1.0 + 0.003 * correlated(rng, len(at), 0.2)[:, 0]) + rng.normal(0.0, 0.2, len(at))
            found.append(Take("press", at, {side: faults[side].counts(forces, rng)}, load))
    return found


def common(
    way: str, calibrated: Scene, faults: Mapping[str, Faults], rng: np.random.Generator
) -> dict[str, SoleCalibration]:
    """Two procedures by weight: one factor by standing on both feet, or one a foot by standing on it alone."""
    motion = calibrated.motion
    counts = {s: faults[s].counts(calibrated.forces[s], rng) for s in SIDES}
    zero = {s: faults[s].counts(np.zeros((100, len(LAYOUTS[s]))), rng).mean(axis=0) for s in SIDES}
    summed = {s: (counts[s] - zero[s]).sum(axis=1) for s in SIDES}
    if way == "common":
        both = motion.slow & (motion.load["left"] > 1.0) & (motion.load["right"] > 1.0)
        factor = dict.fromkeys(SIDES, WEIGHT / float((summed["left"] + summed["right"])[both].mean()))
    else:
        other = {"left": "right", "right": "left"}
        factor = {s: WEIGHT / float(summed[s][motion.slow & (motion.load[other[s]] <= 1.0)].mean()) for s in SIDES}
    return {s: SoleCalibration.linear(np.full(len(zero[s]), factor[s]), zero[s]) for s in SIDES}


def scores(
    known: Mapping[str, SoleCalibration], held_out: Scene, faults: Mapping[str, Faults], rng: np.random.Generator
) -> dict[str, Array]:
    out: dict[str, list[Array]] = {"gain": [], "z": [], "cop": [], "impulse": []}
    for side in SIDES:
        layout = LAYOUTS[side]
        reference = known[side].reference if known[side].reference != 1.0 else 30.0
        error = known[side].gain / faults[side].newtons_per_count(reference) - 1.0
        out["gain"].append(error)
        out["z"].append(error / np.maximum(known[side].gain_error, 1e-12))
        true = held_out.forces[side]
        force = known[side].forces(faults[side].counts(true, rng), layout, RATE)
        on = held_out.motion.load[side] > 0.1 * WEIGHT
        places = layout.positions[:, :2]
        at, where = (f[on] @ places / f[on].sum(axis=1, keepdims=True) for f in (force, true))
        out["cop"].append(1e3 * np.linalg.norm(at - where, axis=1))
        stepping = ~held_out.motion.slow
        out["impulse"].append(np.array([force[stepping].sum() / true[stepping].sum() - 1.0]))
    return {name: np.concatenate(parts) for name, parts in out.items()}


SCATTER = 0.25  # standard deviation of gains before a calibration: within 40 %
OTHERS = ((0.10, 1.0), (0.06, 1.0), (0.01, 1.0), (SCATTER, 2.0), (SCATTER, 4.0))
"""Priors and minutes for which the bound is given, too: a sheet, an FSR, a load cell by data sheets; and longer."""


def bound(calibrated: Scene, prior: float = SCATTER, minutes: float = 1.0) -> tuple[float, float]:
    """Least standard deviation of gains by the noise, all else known (Cramer-Rao): median; and of the CoP in mm.

    `prior`: standard deviation of the gains before; `minutes` of the motion.
    """
    motion = calibrated.motion
    keep = np.exp(-1.0 / (RATE * KEPT))
    n = len(LAYOUTS["left"])
    information = np.eye(2 * n) / prior**2
    for i, side in enumerate(SIDES):
        other = motion.load[SIDES[1 - i]]
        alone = (motion.load[side] > 1.0) & (other <= 1.0)
        for row, arm in enumerate((np.ones(n), *LAYOUTS[side].positions[:, :2].T)):
            size = np.where(motion.slow, SLOW[min(row, 1)], FAST[min(row, 1)]) * WEIGHT
            used = alone if row else np.ones(len(alone), dtype=bool)
            matrix = np.zeros((len(alone), 2 * n))
            matrix[:, i * n : (i + 1) * n] = calibrated.forces[side] * arm
            if row == 0:
                if i:
                    continue
                matrix = np.concatenate([calibrated.forces[s] for s in SIDES], axis=1)
            matrix = matrix / size[:, None]
            both = used[1:] & used[:-1]
            white = (matrix[1:] - keep * matrix[:-1])[both] / np.sqrt(1.0 - keep**2)
            information += minutes * white.T @ white
    covariance = np.linalg.inv(information)
    squares = []
    for i, side in enumerate(SIDES):
        at = slice(i * n, (i + 1) * n)
        known = replace(SoleCalibration.linear(np.ones(n), np.zeros(n)), covariance=covariance[at, at])
        on = np.flatnonzero(motion.load[side] > 0.1 * WEIGHT)[::10]
        squares += [np.sum(known.cop_deviation(LAYOUTS[side], calibrated.forces[side][k]) ** 2) for k in on]
    return float(np.median(np.sqrt(np.diag(covariance)))), 1e3 * float(np.sqrt(np.mean(squares)))


def main(draws: int, ways: list[str]) -> None:
    found: dict[str, list[dict[str, Array]]] = {way: [] for way in ways}
    spent = dict.fromkeys(ways, 0.0)
    bounds = []
    for seed in range(draws):
        if seed % EACH == 0:
            calibrated = scene(10_000 + seed)
            held_out = scene(20_000 + seed)
            bounds.append(bound(calibrated))
        rng = np.random.default_rng(seed)
        faults = {side: Faults.drawn(rng, LAYOUTS[side]) for side in SIDES}
        for way in ways:
            began = time.process_time()
            if way in ("common", "single"):
                known = common(way, calibrated, faults, rng)
            else:
                known = dict(calibrate(takes(way, calibrated, faults, rng), LAYOUTS["left"]).calibrations)
            spent[way] += time.process_time() - began
            found[way].append(scores(known, held_out, faults, rng))
    least = np.median(np.array(bounds), axis=0)
    print(f"bound, by joints, all but gains known: standard deviation {100 * least[0]:.1f} %, CoP {least[1]:.2f} mm")
    for prior, minutes in OTHERS:
        sigma = np.median([bound(scene(10_000 + seed), prior, minutes)[0] for seed in range(0, draws, EACH)])
        print(f"the same with gains known to {100 * prior:g} % before, {minutes:g} minute(s): {100 * sigma:.1f} %")
    for way, rows in found.items():
        gain, cop, impulse = (np.concatenate([row[name] for row in rows]) for name in ("gain", "cop", "impulse"))
        each = [float(np.mean(np.abs(row["z"]) < 1.96)) for row in rows]
        rms = [float(np.sqrt(np.mean(row["cop"] ** 2))) for row in rows]
        print(
            f"| {way} | {len(rows)} "
            f"| {100 * np.median(np.abs(gain)):.1f} | {100 * np.quantile(np.abs(gain), 0.95):.0f} "
            f"| {np.mean(each):.3f} | {np.median(rms):.2f} | {np.quantile(rms, 0.95):.2f} "
            f"| {np.quantile(cop, 0.95):.2f} | {100 * np.median(np.abs(impulse)):.1f} "
            f"| {100 * np.quantile(np.abs(impulse), 0.95):.0f} | {spent[way] / len(rows):.1f} |"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:] or ["robot"])
