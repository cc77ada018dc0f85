"""One stress run, to its end, a fall, or a failure."""

from __future__ import annotations

import traceback
import warnings
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.errors import PlantarError
from plantar.gait.command import Command, Sensors
from plantar.gait.controller import Start
from plantar.gait.plan.footsteps import Footstep
from plantar.sides import SIDES, Side
from plantar.sim.bench.stress.command_check import CommandCheck
from plantar.sim.bench.stress.faults import FaultySensors
from plantar.sim.bench.stress.scenario import Scenario
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

__all__ = ["FAILURES", "LONGEST", "Outcome", "run_scenario"]

LONGEST = 4.0
"""Simulated time in s after which a run is over, whatever its scene has yet to come."""

FAILURES = ("raised", "not finite", "jump", "out of bounds")
"""Outcomes that are faults of the program."""


class Outcome(NamedTuple):
    """What came of a run.

    Attributes:
        kind: "ended", "fell", "stopped" (the controller is in a safe state), "refused" (by the scene), "unstable" (by
            the physics), or one of `FAILURES`.
        detail: In words.
        time: Simulated time in s.
    """

    kind: str
    detail: str
    time: float


class _Faulty(Exception): ...


class _StressedRun(Simulation):
    def __init__(self, scenario: Scenario, longest: float) -> None:
        self._place, self._longest = scenario.place, longest
        super().__init__(load_scene(scenario.scene, scenario.settings, scenario.robot), scenario.number)
        limits: dict[Side, float] = {side: self.robot.layouts[side].force_limit for side in SIDES}
        sensors = FaultySensors(scenario.faults, limits, scenario.number)
        check = CommandCheck(self.body, self.settings.period)
        step, solve = self.controller.step, self.servos.command

        def checked(command: Command) -> NDArray[np.float64]:
            joints = solve(command)
            fault = check.fault(command, joints)
            if fault is not None:
                raise _Faulty(fault)
            return joints

        def stepped(read: Sensors) -> Command:
            return step(sensors.passed(read))

        self.controller.step = stepped  # type: ignore[method-assign, assignment]
        self.servos.command = checked  # type: ignore[method-assign]

    def start_walk(self) -> Start:
        start = super().start_walk()
        feet = {side: self._placed(foot) for side, foot in start.feet.items()}
        return replace(start, feet=feet, steps=tuple(map(self._placed, start.steps)))

    def _placed(self, foot: Footstep) -> Footstep:
        x, y, yaw = self._place
        c, s = float(np.cos(yaw)), float(np.sin(yaw))
        return Footstep(foot.side, x + c * foot.x - s * foot.y, y + s * foot.x + c * foot.y, foot.yaw + yaw, foot.z)

    @property
    def end(self) -> float:
        return min(super().end, self._longest)


def run_scenario(scenario: Scenario, longest: float = LONGEST) -> Outcome:
    """Returns what came of a `scenario`, cut off after the `longest` simulated time in s; raises only what ends the
    program.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        try:
            run = _StressedRun(scenario, longest)
        except PlantarError as error:
            return Outcome("refused", str(error), 0.0)
        except Exception as error:
            return Outcome("raised", _described(error), 0.0)
        try:
            summary: Mapping[str, Any] = run.run()
        except _Faulty as fault:
            kind = str(fault).split(":")[0]
            return Outcome(kind, str(fault), float(run.world.data.time))
        except PlantarError as error:
            kind = "unstable" if "unstable" in str(error) else "raised"
            return Outcome(kind, _described(error), float(run.world.data.time))
        except Exception as error:
            return Outcome("raised", _described(error), float(run.world.data.time))
    time = float(summary["sim_time_s"])
    if run.controller.safe_state is not None:
        return Outcome("stopped", run.controller.safe_state, time)
    return Outcome("fell", summary["reasons"][0]["text"], time) if summary["fell"] else Outcome("ended", "", time)


def _described(error: Exception) -> str:
    last = traceback.extract_tb(error.__traceback__)[-1]
    own = [f for f in traceback.extract_tb(error.__traceback__) if "site-packages" not in f.filename]
    last = own[-1] if own else last
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text} ({'/'.join(last.filename.split('/')[-3:])}:{last.lineno})"
