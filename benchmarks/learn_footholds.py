"""A learned policy for the benchmark of footholds: a stepping pattern with linear feedback of trunk and soles.

    python benchmarks/learn_footholds.py                              trains it by the cross-entropy method
    plantar bench footholds --policy benchmarks/learn_footholds.py    its row

On flat ground it learns rhythm, sway, lift, stride and feedback of the trunk's tilt and turn and of the soles' centres
of pressure; it knows neither the ground nor the footsteps that are asked for. learn_footholds.json has what it learned.
"""

import argparse
import json
import math
import time
from pathlib import Path

import numpy as np

from plantar.sim.bench.footholds.policy import Action

FILE = Path(__file__).with_suffix(".json")
START = {
    "period": (1.4, 0.3), "sway": (0.05, 0.03), "lift": (0.1, 0.08), "stride": (0.03, 0.03), "lead": (0.5, 0.5),
    "tilt_pitch": (0.3, 0.3), "turn_pitch": (0.05, 0.05), "tilt_roll": (0.0, 0.3), "turn_roll": (0.0, 0.05),
    "cop_x": (0.0, 0.3), "cop_y": (0.0, 0.3),
}  # fmt: skip
"""Mean and spread of the first generation: s, rad, rad, rad, rad, and gains in rad per rad, rad/s and m."""
POPULATION, ELITE, GENERATIONS = 16, 4, 20


class Stepping:
    """Steps in a rhythm and turns hips and ankles against tilt and turn of the trunk, and against the soles' load."""

    def __init__(self, task, values):
        self.task, self.v = task, dict(zip(START, values, strict=True))
        self.at = {name: [i for i, joint in enumerate(task.joints) if name in joint] for name in
                   ("hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")}  # fmt: skip
        self.tilt = np.zeros(2)  # roll and pitch, from gyro and accelerometer
        self.places = None

    def step(self, sensors):
        v, dt = self.v, self.task.period
        ax, ay, az = sensors.accelerometer
        seen = np.array([math.atan2(ay, az), math.atan2(-ax, az)])
        self.tilt += dt * np.asarray(sensors.gyro[:2]) + dt * (seen - self.tilt)
        cop = np.zeros(2)
        for side, reading in sensors.readings.items():
            force = np.nan_to_num(reading.force)
            if force.sum() > 20.0:
                cop += 0.5 * (force @ self.layout(side) / force.sum())
        angles = np.array(self.task.stance.angles)
        beat = 2.0 * math.pi * sensors.time / max(v["period"], 0.4)
        grown = min(sensors.time / 2.0, 1.0)
        roll = v["sway"] * grown * math.sin(beat) - v["tilt_roll"] * self.tilt[0] - v["turn_roll"] * sensors.gyro[0]
        pitch = v["tilt_pitch"] * self.tilt[1] + v["turn_pitch"] * sensors.gyro[1] + v["cop_x"] * cop[0]
        for leg in range(2):  # left, right
            phase = beat - v["lead"] + math.pi * (1 - leg)
            lift = v["lift"] * grown * max(math.sin(phase), 0.0) if sensors.time > 1.0 else 0.0
            stride = v["stride"] * grown * math.cos(phase)
            angles[self.at["hip_pitch"][leg]] += stride - lift
            angles[self.at["knee"][leg]] += 2.0 * lift
            angles[self.at["ankle_pitch"][leg]] += -stride - lift - pitch
            angles[self.at["hip_roll"][leg]] += roll
            angles[self.at["ankle_roll"][leg]] += -roll + v["cop_y"] * cop[1]
        return Action(angles, self.task.stance.torques)

    def layout(self, side):
        if self.places is None:
            from plantar.robots.robot_file import load_robot

            layouts = load_robot(self.task.robot).layouts
            self.places = {s: layout.positions[:, :2] for s, layout in layouts.items()}
        return self.places[side]


def make_policy(task):
    return Stepping(task, json.loads(FILE.read_text())["values"])


def train(minutes):
    from plantar.sim.bench.footholds.foothold_run import TRIALS, run_trial

    rng, began, best = np.random.default_rng(0), time.monotonic(), (-1.0, None)
    mean, spread = np.array(list(START.values())).T
    for generation in range(GENERATIONS):
        tried = mean + spread * rng.standard_normal((POPULATION, len(mean)))
        tried[0] = mean
        scores = []
        for values in tried:
            found = run_trial(lambda task, values=values: Stepping(task, values), TRIALS[0], "h1", generation)
            scores.append(found.steps + 0.2 * found.time)
            if scores[-1] > best[0]:
                best = scores[-1], values.tolist()
                text = json.dumps({"values": best[1], "score": best[0], "generation": generation}, indent=1)
                FILE.write_text(text + "\n")
            if time.monotonic() - began > 60.0 * minutes:
                return
        elite = tried[np.argsort(scores)[-ELITE:]]
        mean, spread = elite.mean(axis=0), elite.std(axis=0) + 0.05 * np.array([s for _, s in START.values()])
        print(f"generation {generation}: best {max(scores):.2f}, mean {np.mean(scores):.2f}", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10.0)
    train(parser.parse_args().minutes)
