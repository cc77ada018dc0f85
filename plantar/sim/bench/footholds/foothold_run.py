"""Trials in units of the robot, and a policy's run on one, judged by the truth."""

import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from plantar.common.gravity import GRAVITY
from plantar.errors import InputError
from plantar.gait.command import Sensors
from plantar.robots.controller import JointTargets
from plantar.sim.bench.footholds.observed import Observing
from plantar.sim.bench.footholds.policy import Action, WalkTask
from plantar.sim.judging.velocity_truth import STEPS_TO_REST
from plantar.sim.run.run_summary import verdict_of
from plantar.sim.run.runner import Simulation
from plantar.sim.run.scene import Scene, scene_of

_STEPS = 8
_FORWARD = {"steps": _STEPS, "length": "1/3 leg"}
_SIDEWAYS = {"steps": _STEPS, "length": 0.0, "sideways": "2/15 leg"}


class Trial(NamedTuple):
    """A kind of ground or push at one difficulty.

    `kind`: "flat", "beam", "stones", "slopes", "steps", "push" or "velocity"; `value`: difficulty, in unit; `unit`:
    what the value is a share of.
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
        (0.8, 0.4, 0.2, 0.1),
        "foot's extent across it",
        lambda v: (
            _on(_SIDEWAYS, kind="beam", width=f"{v} sole", length="13/6 leg", offset_range=f"{v / 3} sole")
            | _stood_on(0.2)
        ),
    ),
    (
        "stones",
        (0.8, 0.4, 0.2, 0.1),
        "sole, smallest stone",
        lambda v: _on(_FORWARD, kind="stones", share_min=v, share_max=min(1.0, v + 0.2)) | _stood_on(v),
    ),
    (
        "slopes",
        (2.0, 4.0, 8.0, 16.0),
        "deg",
        lambda v: _on(_FORWARD, kind="uneven", height_range=0.0, slope_range=v) | _stood_on(0.5),
    ),
    (
        "steps",
        (0.0125, 0.025, 0.05, 0.1),
        "leg, up or down",
        lambda v: _on(_FORWARD, kind="uneven", height_range=f"{v} leg") | _stood_on(0.5),
    ),
    (
        "push",
        (0.05, 0.1, 0.2, 0.4),
        "sqrt(g l)",
        lambda v: _on(_FORWARD, kind="flat") | {"push": {"dv": f"{v} leg/beat"}},
    ),
    (
        "velocity",
        (0.02, 0.04, 0.08, 0.16),
        "sqrt(g l), forward",
        lambda v: _on({"velocity": [f"{v} leg/beat", 0.0, 0.0], "until": 6.0}, kind="flat"),
    ),
)

TRIALS = tuple(Trial(kind, v, unit, tables(v)) for kind, values, unit, tables in _KINDS for v in values)
"""All trials, each kind from easy to hard by factors of 2. The first is flat ground."""


def scene_of_trial(trial: Trial, robot: str) -> Scene:
    """Returns the scene of a `trial` for a `robot`; soles read one period late, ankles measure."""
    name = f"{trial.kind}-{trial.value:g}"
    source = {"name": name, "sensing": {"delay_periods": 1, "force_torque": True}, **trial.tables}
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


class TrialRun:
    """A trial under way: a policy senses and acts once a period until it is over.

    Args:
        trial: The trial.
        robot: Name or file.
        seed: Draws ground, push and noise.

    Attributes:
        run: The simulation; a policy does not see it.
        task: What a policy knows of the trial.

    Raises:
        SceneError: If physics become unstable, now or in `act`.
    """

    def __init__(self, trial: Trial, robot: str = "h1", seed: int = 0) -> None:
        self.run = Simulation(scene_of_trial(trial, robot), seed)
        run = self.run
        self._stance = JointTargets(run.legs.joints.copy(), run.legs.torques.copy())
        names = (*run.robot.legs["left"].joints, *run.robot.legs["right"].joints)
        walk = trial.tables["walk"]
        period = run.settings.period
        swings = tuple((phase.start, phase.touchdown) for phase in run.controller.schedule.phases if phase.swing)
        self.task = WalkTask(
            robot, names, period, self._stance, run.feet, tuple(run.steps), _end(run), walk,
            swings=swings, velocities=run.velocities, weight=run.body.weight, leg=run.body.leg,
        )  # fmt: skip
        self._tick_every = round(period / run.world.period)
        self._look_every = round(_LOOK / run.world.period)
        patience = 1.0 if run.velocities is not None else _PATIENCE
        self._last = round(patience * self.task.end / run.world.period)
        self._k = 0
        self._taken_all: float | None = None
        self._sense()

    @property
    def over(self) -> bool:
        """Whether the robot fell, took all steps and stayed up, or had its time."""
        rested = self._taken_all is not None and self.run.world.data.time >= self._taken_all + _STAY
        return self._k >= self._last or self.run.judge.fall is not None or rested

    def sensors(self) -> Sensors:
        """What a policy sees now."""
        return self.run.sensors.read_body()

    def act(self, action: Any) -> None:
        """Follow an `Action` until the next period; InputError if it is none."""
        run = self.run
        judge = run.judge
        data = run.world.data
        angles, torques, moved = _checked(action, self._stance.angles.shape)
        run.servos.follow(angles, torques)
        for i in range(self._tick_every):
            run.advance()
            if i == 0:
                judge.update(data.time, data.subtree_com[run.world.torso], None, moved, run.pusher.pushing)
                if run.speeds is not None:
                    run.speeds.update(data.time)
            looked = self._k % self._look_every == 0 and run.velocities is None and self._taken_all is None
            if looked and judge.steps.count().taken == len(run.steps):
                self._taken_all = float(data.time)
            self._k += 1
            self._sense()
            if self.over:
                break

    def _sense(self) -> None:
        if self._k % self.run.sensors.skin_every == 0:
            self.run.sensors.read_skins()

    def result(self) -> FootholdResult:
        """What came of it."""
        run = self.run
        judge = run.judge
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
            float(run.world.data.time),
            tuple(reason["criterion"] for reason in why),
        )


def _end(run: Simulation) -> float:
    """Time in s at which the built-in controller has ended a walk and stood still.

    A walk by velocity gets its last steps when it is told to stop: as many as it is allowed until it rests.
    """
    if run.velocities is None:
        return run.end
    timing = run.settings.timing
    last_steps = STEPS_TO_REST * (timing.single_support + timing.double_support)
    return run.velocities.times[-1] + last_steps + timing.end + timing.settle


def run_trial(make_policy: Any, trial: Trial, robot: str = "h1", seed: int = 0) -> FootholdResult:
    """Returns the result of `make_policy`'s policy on a `trial` with a `robot` (name or file).

    `seed` draws ground, push and noise. InputError if the policy fails, SceneError if physics become unstable.
    """
    under_way = TrialRun(trial, robot, seed)
    policy = _called(make_policy, under_way.task)
    if callable(getattr(policy, "act", None)):
        policy = Observing(policy, under_way.task)
    if not callable(getattr(policy, "step", None)):
        raise InputError(
            f"make_policy(task) returned {policy!r}; allowed: an object with a method step(sensors) or act(observation)"
        )
    while not under_way.over:
        under_way.act(_called(policy.step, under_way.sensors()))
    return under_way.result()


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
