"""A policy of your own for the benchmark of footholds: what `plantar bench footholds --policy FILE` needs.

    plantar bench footholds --policy examples/own_policy.py --seeds 10

It holds the standing posture and leans against what the soles report, so it keeps standing when pushed and takes no
step: the row that every policy has to beat.
"""

import numpy as np

from plantar.sim.bench.footholds.policy import Action


class Standing:
    """Moves the ankles by where the soles' center of pressure is."""

    def __init__(self, task):
        self.task = task
        self.ankles = [i for i, name in enumerate(task.joints) if "ankle" in name and "pitch" in name]

    def step(self, sensors):
        angles = np.array(self.task.stance.angles)
        total = sum(reading.force.sum() for reading in sensors.readings.values())
        if total > 0.0:
            pitch_rate = sensors.gyro[1]
            angles[self.ankles] -= 0.02 * pitch_rate
        return Action(angles, self.task.stance.torques)


def make_policy(task):
    return Standing(task)


if __name__ == "__main__":
    from plantar.sim.bench.footholds.foothold_run import run_trial
    from plantar.sim.bench.footholds.trials import TRIALS

    print(run_trial(make_policy, TRIALS[-1], "h1", seed=0))
