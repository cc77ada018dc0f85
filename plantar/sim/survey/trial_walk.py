"""A new robot's first steps in simulation: what walking alone leaves to its push estimate."""

import math

from plantar.common.console.ending import one_line
from plantar.errors import PlantarError
from plantar.gait.estimate.push_estimate import PushRules
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

_STEPS = 8
_STANDS_OUT = 1.5  # of what level ground leaves: other ground leaves more, and a push has to stand out of it
_SILENT = 90  # m/s^2, above which a push would be
_RULES = PushRules()


class _Trial(Simulation):
    """Steps on level ground; `level` is the largest disagreement of ZMP and acceleration in m/s^2."""

    level = 0.0

    def control(self) -> float:
        used = super().control()
        push = self.controller.estimation.estimator.push
        assert push is not None
        self.level = max(self.level, math.hypot(*push.disagreement.tolist()))
        return used


def trial_walk(robot_file: str) -> tuple[float, list[str]]:
    """Walk level ground; returns the largest acceleration in m/s^2 that ZMP and IMU disagreed by, and notes."""
    try:
        trial = _Trial(load_scene("flat", [f"walk.steps={_STEPS}", f"push_estimate.begins={_SILENT}"], robot_file), 0)
    except PlantarError as error:
        return 0.0, [f"its trial walk cannot begin: {one_line(error)}"]
    summary = trial.run()
    missed = ", ".join(str(reason["criterion"]) for reason in summary["reasons"])
    level = 0.0 if summary["fell"] else trial.level  # what a fall leaves is no walk's
    return level, [f"its first steps on level ground missed {missed} in simulation"] if missed else []


def push_text(level: float) -> str:
    """Robot file's table of thresholds that a push has to exceed, by what walking leaves in m/s^2; "" for others'."""
    begins = math.ceil(10.0 * _STANDS_OUT * level) / 10.0
    text = (
        "\n[push_estimate]\n"
        f"# ZMP and IMU disagree by up to {level:.2g} m/s^2 as it walks level ground, in simulation: no push yet.\n"
        f"begins = {begins:g}  # m/s^2\nends = {begins * _RULES.ends / _RULES.begins:.2g}  # m/s^2\n"
    )
    return text if begins > _RULES.begins else ""
