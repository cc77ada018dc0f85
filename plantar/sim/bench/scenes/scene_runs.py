"""The single runs of `plantar bench scenes`."""

import time
from collections.abc import Iterator, Sequence
from functools import partial
from statistics import median
from typing import Any, NamedTuple

from plantar.bench.kind import Case, Row
from plantar.errors import PlantarError
from plantar.sim.bench.scenes.changed_run import ChangedRun, Trace, TracedRun, trace_error
from plantar.sim.bench.scenes.scene_setting import OWN, SceneSetting, setting_named

KEYS = ("scene", "robot", "walk", "setting", "against", "kind", "seed")
"""Columns that name a run."""

COLUMNS = (
    *("sim_s", "cpu_s", "completed", "impact_N", "margin_mm"),
    *("com_mm", "zmp_mm", "force", "impact", "together_s"),
)
"""Kind is "traced" (without the sensors' noise, next to the run that it is compared with), "noise" (the scene's own run
with noise next to itself without), or "seeded" (with noise, for the statistics)."""


class SceneCase(NamedTuple):
    """A walk run in many ways, with settings `walk` in all."""

    scene: str
    robot: str
    walk: tuple[str, ...] = ()


class SceneRuns:
    """The runs of a walk in all settings; a traced run is kept while others are compared with it."""

    def __init__(self) -> None:
        self._traces: dict[tuple[SceneCase, str, int], tuple[dict[str, Any], Trace]] = {}

    def cases(
        self, walks: Sequence[SceneCase], settings: Sequence[SceneSetting], seeds: Sequence[int], traced: int
    ) -> list[Case]:
        """Returns cases of `walks` with each of `settings` in turn, against busy minutes, and `seeds`; the motions of
        the first `traced` seeds are compared.
        """
        return [
            Case(job.key, partial(self._rows, job)) for walk in walks for job in _jobs(walk, settings, seeds, traced)
        ]

    def _rows(self, job: "_Job") -> list[Row]:
        return [self._measure(job)]

    def _measure(self, job: "_Job") -> dict[str, Any]:
        try:
            if job.kind == "seeded":
                return _costs(ChangedRun(*job.case[:2], job.setting, job.seed, job.case.walk))
            if job.kind == "noise":
                run = TracedRun(*job.case[:2], OWN, job.seed, job.case.walk)
                outcome = _costs(run)
                trace = run.trace()
            else:
                outcome, trace = self._traced(job.case, job.setting, job.seed)
            error = trace_error(trace, self._traced(job.case, setting_named(job.against), job.seed)[1])
        except PlantarError as failure:
            return {"completed": f"no: {failure}"}
        return {
            **outcome,
            "com_mm": f"{1e3 * error.com_m:.4f}",
            "zmp_mm": f"{1e3 * error.zmp_m:.3f}",
            "force": f"{error.force:.5f}",
            "impact": f"{error.impact:.4f}",
            "together_s": f"{error.together_s:.2f}",
        }

    def _traced(self, case: SceneCase, setting: SceneSetting, seed: int) -> tuple[dict[str, Any], Trace]:
        key = (case, setting.name, seed)
        if key not in self._traces:
            self._traces = {k: v for k, v in self._traces.items() if k[0] == case and k[2] == seed}
            run = TracedRun(*case[:2], setting, seed, case.walk, noisy=False)
            outcome = _costs(run)
            self._traces[key] = outcome, run.trace()
        return self._traces[key]


class _Job(NamedTuple):
    case: SceneCase
    setting: SceneSetting
    against: str
    kind: str
    seed: int

    @property
    def key(self) -> tuple[str, ...]:
        scene, robot, walk = self.case
        return scene, robot, " ".join(walk), self.setting.name, self.against, self.kind, str(self.seed)


def _jobs(case: SceneCase, settings: Sequence[SceneSetting], seeds: Sequence[int], traced: int) -> Iterator[_Job]:
    references = list(dict.fromkeys(s.against for s in settings))
    for seed in seeds[:traced]:
        for setting in settings:
            own = [setting.name] if setting.name in references else [setting.against]
            for against in references if setting is OWN else own:
                yield _Job(case, setting, against, "traced", seed)
        yield _Job(case, OWN, OWN.name, "noise", seed)
    for seed in seeds:
        for setting in settings:
            yield _Job(case, setting, "", "seeded", seed)


def _costs(run: ChangedRun) -> dict[str, Any]:
    start = time.process_time()
    summary = run.run()
    used = time.process_time() - start - (run.keeping_s if isinstance(run, TracedRun) else 0.0)
    impacts = summary["impacts_N"]
    margin = summary["zmp_margin_min_m"]
    if isinstance(run, TracedRun):
        run.keep_landings(summary)
    return {
        "sim_s": summary["sim_time_s"],
        "cpu_s": round(used, 4),
        "completed": "yes" if summary["completed"] else "no: " + " ".join(r["criterion"] for r in summary["reasons"]),
        "impact_N": round(median(impacts), 1) if impacts else "",
        "margin_mm": "" if margin is None else round(1e3 * margin, 2),
    }
