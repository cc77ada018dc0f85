"""A policy of your own for the benchmark of footholds: what `plantar bench footholds --policy FILE` needs.

    python examples/own_policy.py
    plantar bench footholds --policy examples/own_policy.py --seeds 10

While a sole carries, it turns the ankles against the trunk's pitch rate; it takes no step: every policy has to beat it.
"""

import numpy as np

from plantar.sim.bench.footholds.policy import Action


class Standing:
    """Holds the standing posture."""

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
    from plantar.sim.bench.footholds.foothold_run import TRIALS, run_trial

    print(run_trial(make_policy, TRIALS[0], "h1", seed=0))
