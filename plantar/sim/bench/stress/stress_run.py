"""`plantar bench stress`: the whole loop in random short scenarios."""

import traceback
import warnings
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.bench.kind import BenchOptions, Case, Finding, Kind, PageTable, Row
from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError, PlantarError
from plantar.gait.command import Command, Sensors
from plantar.gait.controller import Start
from plantar.gait.plan.footsteps import Footstep
from plantar.sim.bench.stress.faults import FaultySensors
from plantar.sim.bench.stress.scenario import Scenario, draw_scenario
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import load_scene

_FASTEST = 12.0  # leg/beat of a foot's or the CoM's target, a step a beat long ten times over: beyond it, it jumps
_FARTHEST = 3.0  # leg from the middle between the feet to the CoM's target: it cannot be meant
_LIFTED = 0.02  # leg that a target may jump by at once: where a foot touches down its target is where it is


class CommandCheck:
    """Checks each command of a run with a control `period` in s."""

    def __init__(self, body: BodyScale, period: float) -> None:
        self._body = body
        self._step = _FASTEST * body.leg / body.beat * period + _LIFTED * body.leg
        self._last: list[NDArray[np.float64]] | None = None

    def fault(self, command: Command, joints: NDArray[np.float64]) -> str | None:
        """Returns what is wrong with a `command` and its `joints` (k,) in rad, or None."""
        feet = [command.feet[side] for side in SIDES]
        every = {
            "CoM": command.com,
            "torso": command.rotation_torso,
            "desired ZMP": command.zmp_desired,
            "joints": joints,
            **{f"{side} sole": foot.position for side, foot in zip(SIDES, feet, strict=True)},
            **{f"{side} sole's rotation": foot.rotation for side, foot in zip(SIDES, feet, strict=True)},
            **{f"{side} sole's force": foot.force for side, foot in zip(SIDES, feet, strict=True)},
            **{f"{side} centre of pressure": foot.center_of_pressure for side, foot in zip(SIDES, feet, strict=True)},
        }
        if command.joint_offsets is not None:
            every["joint offsets"] = command.joint_offsets
        for name, values in every.items():
            if not np.isfinite(values).all():
                return f"not finite: {name}"
        targets = [command.com, *(foot.position for foot in feet)]
        last = self._last
        self._last = targets
        middle = 0.5 * (feet[0].position + feet[1].position)
        if float(np.linalg.norm(command.com - middle)) > _FARTHEST * self._body.leg:
            return "out of bounds: the CoM is far from the feet"
        if last is not None:
            for name, now, before in zip(("CoM", "left sole", "right sole"), targets, last, strict=True):
                way = float(np.linalg.norm(now - before))
                if way > self._step:
                    return f"jump: {name} by {way:.3g} m in a tick"
        for name, rotation in (("torso", command.rotation_torso), *zip(SIDES, (f.rotation for f in feet), strict=True)):
            if float(np.abs(rotation @ rotation.T - np.eye(3)).max()) > 1e-6:
                return f"out of bounds: {name} is turned by no rotation"
        return None


LONGEST = 4.0
"""Simulated time in s after which a run is over, whatever its scene has yet to come."""

FAILURES = ("raised", "not finite", "jump", "out of bounds")
"""Outcomes that are faults of the program."""


class Outcome(NamedTuple):
    """What came of a run.

    `kind`: "ended", "fell", "stopped" (controller in a safe state), "refused" (by scene), "unstable" (physics), or one
    of `FAILURES`; `time`: simulated time in s.
    """

    kind: str
    detail: str
    time: float


class _Faulty(Exception): ...


class _StressedRun(Simulation):
    def __init__(self, scenario: Scenario, longest: float) -> None:
        self._place = scenario.place
        self._longest = longest
        super().__init__(load_scene(scenario.scene, scenario.settings, scenario.robot), scenario.number)
        limits: dict[Side, float] = {side: self.robot.layouts[side].force_limit for side in SIDES}
        sensors = FaultySensors(scenario.faults, limits, scenario.number)
        check = CommandCheck(self.body, self.settings.period)
        step = self.controller.step
        solve = self.servos.command

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

    def placed(self, start: Start) -> Start:
        feet = {side: self._moved(foot) for side, foot in start.feet.items()}
        return replace(start, feet=feet, steps=tuple(map(self._moved, start.steps)))

    def _moved(self, foot: Footstep) -> Footstep:
        x, y, yaw = self._place
        c = float(np.cos(yaw))
        s = float(np.sin(yaw))
        return Footstep(foot.side, x + c * foot.x - s * foot.y, y + s * foot.x + c * foot.y, foot.yaw + yaw, foot.z)

    @property
    def end(self) -> float:
        return min(super().end, self._longest)


def run_scenario(scenario: Scenario, longest: float = LONGEST) -> Outcome:
    """Returns what came of a `scenario`, cut off after `longest` simulated s; failures are outcomes."""
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
        except Exception as error:
            kind = "unstable" if isinstance(error, PlantarError) and "unstable" in str(error) else "raised"
            return Outcome(kind, _described(error), float(run.world.data.time))
    time = float(summary["sim_time_s"])
    if run.controller.safe_state is not None:
        return Outcome("stopped", run.controller.safe_state, time)
    return Outcome("fell", summary["reasons"][0]["text"], time) if summary["fell"] else Outcome("ended", "", time)


def _described(error: Exception) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    last = ([f for f in frames if "site-packages" not in f.filename] or frames)[-1]
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text} ({'/'.join(last.filename.split('/')[-3:])}:{last.lineno})"


_QUICK = 3  # scenarios of a quick run


def _cases(options: BenchOptions) -> list[Case]:
    if options.scenarios < 1:
        raise InputError(f"stress run of {options.scenarios} scenarios; allowed: 1 or more")
    return [Case((str(number),), partial(_measure, number)) for number in _numbers(options)]


def _numbers(options: BenchOptions) -> range:
    return range(options.first, options.first + (_QUICK if options.quick else options.scenarios))


def _measure(number: int) -> list[Row]:
    scenario = draw_scenario(number)
    found = run_scenario(scenario)
    return [
        {
            "scene": scenario.scene,
            "robot": scenario.robot,
            "outcome": found.kind,
            "detail": found.detail,
            "time_s": round(found.time, 3),
        }
    ]


def _find(rows: Sequence[Row], options: BenchOptions) -> Finding:
    wanted = set(map(str, _numbers(options)))
    own = [row for row in rows if row["number"] in wanted]
    outcomes = dict(Counter(row["outcome"] for row in own).most_common())
    failed = [row for row in own if row["outcome"] in FAILURES]
    result = {
        "scenarios": len(wanted),
        "first": options.first,
        "outcomes": outcomes,
        "simulated_s": round(sum(float(row["time_s"]) for row in own), 1),
        "failures": failed,
    }
    tables = [PageTable("Outcomes", ("outcome", "scenarios"), list(outcomes.items()))]
    if failed:
        lines = [(r["number"], r["scene"], r["robot"], r["detail"]) for r in failed]
        tables.append(PageTable("Failed", ("number", "scene", "robot", "what is wrong"), lines))
    failures = (f"{len(failed)} of {len(wanted)} scenarios failed",) if failed else ()
    return Finding(result, tables, failures)


STRESS = Kind(
    page="stress",
    title="The whole loop in random short scenarios",
    lead=(
        "Each scenario is drawn by its number: scene, robot, gains, noise and faulty sensors. `plantar bench stress\n"
        "--first N --scenarios 1` repeats one. Only a failed one is a fault of the program."
    ),
    table="stress.csv",
    keys=("number",),
    columns=("scene", "robot", "outcome", "detail", "time_s"),
    cases=_cases,
    find=_find,
)
"""`plantar bench stress`."""
