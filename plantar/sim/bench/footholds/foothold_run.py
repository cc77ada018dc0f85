"""Trials in units of the robot, and a policy's run on one, judged by the truth."""

import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.robots.controller import JointTargets
from plantar.sim.bench.footholds.policy import Action, WalkTask
from plantar.sim.run.run_summary import verdict_of
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Scene, scene_of

_STEPS = 8
_FORWARD = {"steps": _STEPS, "length": "1/3 leg"}
_SIDEWAYS = {"steps": _STEPS, "length": 0.0, "sideways": "2/15 leg"}


class Trial(NamedTuple):
    """A kind of ground or push at one difficulty.

    `kind`: "beam", "stones", "slopes", "steps" or "push"; `value`: difficulty, in unit; `unit`: what the value is a
    share of.
    """

    kind: str
    value: float
    unit: str
    tables: Mapping[str, Mapping[str, Any]]


def _on(walk: Mapping[str, Any], **terrain: Any) -> dict[str, Mapping[str, Any]]:
    return {"terrain": terrain, "walk": walk}


def _stood_on(share: float) -> dict[str, Mapping[str, Any]]:
    """No piece of ground that covers nearly a `share` of a footprint is skipped."""
    return {"outcome": {"stood_on": {"covers": 0.9 * share}}}


_KINDS: tuple[tuple[str, tuple[float, ...], str, Callable[[float], dict[str, Mapping[str, Any]]]], ...] = (
    ("flat", (0.0,), "", lambda _: _on(_FORWARD, kind="flat")),
    (
        "beam",
        (0.8, 0.5, 0.33, 0.25),
        "foot's extent across it",
        lambda v: (
            _on(_SIDEWAYS, kind="beam", width=f"{v} sole", length="13/6 leg", offset_range=f"{v / 3} sole")
            | _stood_on(0.2)
        ),
    ),
    (
        "stones",
        (0.8, 0.6, 0.4, 0.2),
        "sole, smallest stone",
        lambda v: _on(_FORWARD, kind="stones", share_min=v, share_max=min(1.0, v + 0.2)) | _stood_on(v),
    ),
    (
        "slopes",
        (2.0, 5.0, 8.0),
        "deg",
        lambda v: _on(_FORWARD, kind="uneven", height_range=0.0, slope_range=v) | _stood_on(0.5),
    ),
    (
        "steps",
        (0.0125, 0.025, 0.05),
        "leg, up or down",
        lambda v: _on(_FORWARD, kind="uneven", height_range=f"{v} leg") | _stood_on(0.5),
    ),
    (
        "push",
        (0.05, 0.1, 0.15),
        "sqrt(g l)",
        lambda v: _on(_FORWARD, kind="flat") | {"push": {"dv": f"{v} leg/beat"}},
    ),
)

TRIALS = tuple(Trial(kind, v, unit, tables(v)) for kind, values, unit, tables in _KINDS for v in values)
"""All trials, each kind from easy to hard. The first is flat ground."""


def scene_of_trial(trial: Trial, robot: str) -> Scene:
    """Returns the scene of a `trial` for a `robot`; soles read one period late."""
    name = f"{trial.kind}-{trial.value:g}"
    source = {"name": name, "sensing": {"delay_periods": 1}, **trial.tables}
    return scene_of(source, Path(f"{name}.toml"), (), robot)


_PATIENCE = 1.5  # times the built-in controller's time until a run is cut off
_LOOK = 0.25  # s from one look for the last step to the next
_STAY = 1.0  # s that the robot has to stay up after its last step


class FootholdResult(NamedTuple):
    """What came of a run.

    `completed`: whether no criterion of a run failed; `tilt`: largest tilt of torso in degrees; `froude`: v^2 / (g l),
    v the way over the time from first to last step; `time`: simulated time in s; `failed`: names of the criteria that
    failed, as of `plantar sim`.
    """

    completed: bool
    steps: int
    planned: int
    fell: bool
    tilt: float
    froude: float
    time: float
    failed: tuple[str, ...] = ()


def run_trial(make_policy: Any, trial: Trial, robot: str = "h1", seed: int = 0) -> FootholdResult:
    """Returns the result of `make_policy`'s policy on a `trial` with a `robot` (name or file).

    `seed` draws ground, push and noise. InputError if the policy fails, SceneError if physics become unstable.
    """
    run = Simulation(scene_of_trial(trial, robot), seed)
    world = run.world
    data = run.world.data
    judge = run.judge
    stance = JointTargets(run.legs.joints.copy(), run.legs.torques.copy())
    names = (*run.robot.legs["left"].joints, *run.robot.legs["right"].joints)
    period = run.settings.period
    task = WalkTask(robot, names, period, stance, run.feet, run.steps, run.end, trial.tables["walk"])
    policy = _called(make_policy, task)
    if not callable(getattr(policy, "step", None)):
        raise InputError(f"make_policy(task) returned {policy!r}; allowed: an object with a method step(sensors)")
    tick_every = round(period / world.period)
    look_every = round(_LOOK / world.period)
    last = round(_PATIENCE * run.end / world.period)
    k = 0
    taken_all = None
    while k < last and judge.fall is None and (taken_all is None or data.time < taken_all + _STAY):
        if k % run.sensors.skin_every == 0:
            run.sensors.read_skins()
        if k % tick_every == 0:
            angles, torques, moved = _checked(_called(policy.step, run.sensors.read_body()), stance.angles.shape)
            run.servos.follow(angles, torques)
        run.advance()
        if k % tick_every == 0:
            judge.update(data.time, data.subtree_com[world.torso], None, moved, run.pusher.pushing)
        if k % look_every == 0 and taken_all is None and judge.steps.count().taken == len(run.steps):
            taken_all = float(data.time)
        k += 1
    count = judge.steps.count()
    speed = 0.0
    if count.taken > 1:
        start = np.mean([foot.position[:2] for foot in run.feet.values()], axis=0)
        way = np.mean([stand.place[:2] for stand in count.stands[-2:]], axis=0) - start
        speed = float(np.hypot(*way)) / max(count.stands[-1].touchdown - count.stands[0].touchdown, 1e-9)
    _, why = verdict_of(run, count, {})
    return FootholdResult(
        not why,
        count.taken,
        len(run.steps),
        judge.fell,
        judge.tilt_max,
        speed**2 / (GRAVITY * run.body.leg),
        float(data.time),
        tuple(reason["criterion"] for reason in why),
    )


def _checked(given: Any, shape: tuple[int, ...]) -> tuple[Any, Any, Any]:
    """Angles and torques (k,) and moved steps of a policy's action; InputError if it is none."""
    try:
        action = Action(*given)
        angles = np.asarray(action.angles, dtype=np.float64)
        torques = np.zeros(shape) if action.torques is None else np.asarray(action.torques, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"policy returned {given!r:.80}; allowed: Action(angles, torques)") from None
    if not angles.shape == torques.shape == shape or not (np.isfinite(angles).all() and np.isfinite(torques).all()):
        raise InputError(f"policy returned angles of shape {angles.shape}; expected {shape[0]} finite ones")
    return angles, torques, action.moved


def _called(function: Any, argument: Any) -> Any:
    try:
        return function(argument)
    except Exception as problem:  # whatever the policy raises
        at = traceback.extract_tb(problem.__traceback__)[:2][-1]  # where the policy is called, or its own line
        where = f"{Path(at.filename).name}, line {at.lineno}"
        raise InputError(f"policy raised {type(problem).__name__}: {problem} ({where})") from problem
