"""A new robot's trial in simulation: level ground, a stone under a part of its sole, a slab, and a push."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from plantar.common.console.ending import one_line
from plantar.common.settings.body_scale import BodyScale
from plantar.errors import InputError, PlantarError
from plantar.gait.estimate.push_estimate import PushRules
from plantar.sim.run.runner import Simulation, run_scene
from plantar.sim.run.scene import load_scene

TRIALS: Mapping[str, str] = {"flat": "flat", "stone": "partial-third", "slab": "obstacle", "push": "push"}
"""Scene of each trial, in their order; without level ground the others are not walked."""

_SIZES: Mapping[str, tuple[str, str]] = {"slab": ("terrain", "top"), "push": ("push", "dv")}
"""Section and setting of what grows with the body, in those trials in which it makes them harder."""

_STEPS = 8
_STANDS_OUT = 1.5  # of what level ground leaves: other ground leaves more, and a push has to stand out of it
_SILENT = 90  # m/s^2, above which a push would be
_RULES = PushRules()


@dataclass(frozen=True)
class Trial:
    """One trial.

    Attributes:
        name: Of `TRIALS`.
        missed: What the judge missed, or why it was not walked; empty where it is completed.
        steps: Footholds taken.
    """

    name: str
    missed: str
    steps: int = 0

    @property
    def completed(self) -> bool:
        """Whether nothing was missed."""
        return not self.missed

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values."""
        return {"name": self.name, "scene": TRIALS[self.name], "completed": self.completed, "missed": self.missed}

    def text(self) -> str:
        """As a line."""
        ends = f"completed, {self.steps} steps" if self.completed else f"missed {self.missed}"
        return f"{self.name} (plantar sim {TRIALS[self.name]}): {ends}"


class _Level(Simulation):
    """Steps on level ground; `level` is the largest disagreement of ZMP and acceleration in m/s^2."""

    level = 0.0

    def control(self) -> float:
        used = super().control()
        push = self.controller.estimation.estimator.push
        assert push is not None
        self.level = max(self.level, math.hypot(*push.disagreement.tolist()))
        return used


def trial_names(text: str) -> tuple[str, ...]:
    """Returns the trials that a `text` names, separated by commas; level ground is always the first.

    Raises:
        InputError: If one is unknown.

    Example:
        >>> trial_names("push, stone")
        ('flat', 'stone', 'push')
    """
    named = {name.strip() for name in text.split(",")}
    unknown = sorted(named - set(TRIALS))
    if unknown:
        raise InputError(f"--trials names '{unknown[0]}'; allowed: {', '.join(TRIALS)}, separated by commas")
    return tuple(name for name in TRIALS if name in named | {"flat"})


def level_trial(robot_file: str) -> tuple[float, Trial]:
    """Walk level ground; returns the largest acceleration in m/s^2 that ZMP and IMU disagreed by, and the trial."""
    settings = [f"walk.steps={_STEPS}", f"push_estimate.begins={_SILENT}"]
    try:
        run = _Level(load_scene("flat", settings, robot_file), 0)
    except PlantarError as error:
        return 0.0, Trial("flat", f"its begin: {one_line(error)}")
    summary = run.run()
    level = 0.0 if summary["fell"] else run.level  # what a fall leaves is no walk's
    return level, _judged("flat", summary)


def other_trials(robot_file: str, names: Sequence[str], level: Trial, body: BodyScale | None = None) -> list[Trial]:
    """Walk the trials of `names` but the first, which was `level`; all with seed 0.

    `body`: whose slab and push they are, in m and m/s; by default the robot's own.
    """
    if not level.completed:
        return [Trial(name, "its turn, as level ground is missed") for name in names[1:]]
    trials = []
    for name in names[1:]:
        try:
            settings = () if body is None else _as_for(body, name)
            trials.append(_judged(name, run_scene(load_scene(TRIALS[name], settings, robot_file), 0)))
        except PlantarError as error:
            trials.append(Trial(name, f"its begin: {one_line(error)}"))
    return trials


def _as_for(body: BodyScale, name: str) -> tuple[str, ...]:
    """Settings that make a trial of another robot as high and hard as that of a `body`."""
    if name not in _SIZES:
        return ()
    section, setting = _SIZES[name]
    size = getattr(getattr(load_scene(TRIALS[name]).for_body(body), section), setting)
    return (f"{section}.{setting}={size}",)


def _judged(name: str, summary: Mapping[str, Any]) -> Trial:
    missed = ", ".join(dict.fromkeys(str(reason["criterion"]) for reason in summary["reasons"]))
    return Trial(name, missed, int(summary["steps_taken"]))


def push_text(level: float) -> str:
    """Robot file's table of thresholds that a push has to exceed, by what walking leaves in m/s^2; "" for others'."""
    begins = math.ceil(10.0 * _STANDS_OUT * level) / 10.0
    text = (
        "\n[push_estimate]\n"
        f"# ZMP and IMU disagree by up to {level:.2g} m/s^2 as it walks level ground, in simulation: no push yet.\n"
        f"begins = {begins:g}  # m/s^2\nends = {begins * _RULES.ends / _RULES.begins:.2g}  # m/s^2\n"
    )
    return text if begins > _RULES.begins else ""
