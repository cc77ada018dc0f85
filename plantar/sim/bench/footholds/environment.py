"""The trials of `plantar bench footholds` as a Gymnasium environment: same ground, sensors, body and judge."""

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError, SceneError
from plantar.sim.bench.footholds.foothold_run import TRIALS, Trial, TrialRun
from plantar.sim.bench.footholds.observed import PERIOD, Observer, set_points
from plantar.sim.environments.gymnasium_base import Env, spaces

_DRAWN = 2**31  # seeds of trials


class FootholdEnv(Env[dict[str, NDArray[np.float32]], NDArray[np.float32]]):
    """A trial of the benchmark of footholds, drawn at each reset.

    Observation, action and period are those of `PlantarEnv`, as a robot's sensors know them (see `Observer`): a policy
    `act(observation)` of it is a policy of `plantar bench footholds` as it is. The reward of a step is 1 for each
    footstep that was taken in its place, and up to 0.02 for an upright torso. An episode ends with a fall, or where the
    trial does. Its last `info` has "completed", "steps", "planned", "fell" and "failed", criteria's names.

    `kind`, `value`: of the trials that are drawn; None for all. `robot`: name or file. `skin`: whether it is observed.
    """

    def __init__(
        self,
        kind: str | None = None,
        value: float | None = None,
        robot: str | os.PathLike[str] = "h1",
        *,
        skin: bool = True,
    ) -> None:
        self._trials = [t for t in TRIALS if kind in (None, t.kind) and value in (None, t.value)]
        if not self._trials:
            known = ", ".join(f"{t.kind} {t.value:g}" for t in TRIALS)
            raise InputError(f"no trial is {kind} {value}; allowed: {known}")
        if len({t.kind == "velocity" for t in self._trials}) > 1:
            self._trials = [t for t in self._trials if t.kind != "velocity"]  # which observe something else
        self._robot = str(robot)
        self._skin = skin
        self._run: TrialRun | None = None
        self.period = PERIOD
        first = self._begin(self._trials[0], 0)
        self.observation_space = spaces.Dict({name: _box(len(part)) for name, part in first.items()})
        self.action_space = spaces.Box(-1.0, 1.0, (len(self._under_way.task.joints),), np.float32)
        self._run = None

    @property
    def _under_way(self) -> TrialRun:
        if self._run is None:
            raise InputError("the environment has no episode yet; call reset() before step()")
        return self._run

    def _begin(self, trial: Trial, seed: int) -> dict[str, NDArray[np.float32]]:
        self._run = TrialRun(trial, self._robot, seed)
        self._observer = Observer(self._run.task)
        self._taken = 0
        sensors = self._run.sensors()
        self._observer.sense(sensors)
        return self._seen(sensors)

    def _seen(self, sensors: Any) -> dict[str, NDArray[np.float32]]:
        found = self._observer.observation(sensors)
        return found if self._skin else {n: v for n, v in found.items() if not n.startswith("skin")}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, Any]]:
        """Returns observation and info of a trial drawn by `seed`; `options` may have the benchmark's own "seed"."""
        super().reset(seed=seed)
        trial = self._trials[int(self.np_random.integers(len(self._trials)))]
        drawn = int(self.np_random.integers(_DRAWN))
        observation = self._begin(trial, int((options or {}).get("seed", drawn)))
        return observation, {"kind": trial.kind, "value": trial.value}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[dict[str, NDArray[np.float32]], float, bool, bool, dict[str, Any]]:
        """One control step of 0.02 s: `action` (k,) of -1 to 1. Returns observation, reward, end, False and info."""
        run = self._under_way
        targets = set_points(run.task, action)
        try:
            while True:
                run.act(targets)
                sensors = run.sensors()
                if self._observer.sense(sensors) or run.over:
                    break
        except SceneError:  # physics became unstable
            return (
                self._seen(run.sensors()),
                0.0,
                True,
                False,
                {"completed": False, "fell": True, "failed": ("unstable",)},
            )
        judge = run.run.judge
        taken = judge.steps.count().taken
        upright = float(run.run.world.data.xmat[run.run.world.torso, 8])
        reward = float(taken - self._taken) + 0.02 * max(upright, 0.0)
        self._taken = taken
        info: dict[str, Any] = {"steps": taken}
        if run.over:
            found = run.result()
            info |= {name: getattr(found, name) for name in ("completed", "steps", "planned", "fell", "failed")}
        return self._seen(sensors), reward, run.over, False, info


def _box(size: int) -> spaces.Box:
    return spaces.Box(-np.inf, np.inf, (size,), np.float32)
