"""Recordings of a study, measured by this process or by several: each result is kept, and found again."""

import os
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path

from plantar.common.workers.cluster_workers import ClusterWorkers
from plantar.common.workers.local_workers import LocalWorkers
from plantar.common.workers.workers import Job
from plantar.errors import InputError, PlantarError
from plantar.formats import ReadOptions
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.study.one_recording import (
    RecordingResult,
    digest_of,
    key_of,
    measure_recording,
    read_result,
    write_result,
)
from plantar.gait.analysis.study.participants import Participation
from plantar.gait.analysis.study.study_options import StudyOptions


@dataclass(frozen=True, eq=False)
class Measurement:
    """A worker's task: a recording of a study, and the folder `cache` where its result is kept."""

    root: Path
    cache: Path
    who: Participation
    choices: AnalysisOptions
    options: ReadOptions | None


def measured(tasks: Sequence[Measurement], plan: StudyOptions) -> Iterator[tuple[Measurement, RecordingResult]]:
    """Tasks and results as they end; each result is kept as soon as it is known, so that a stopped study goes on."""
    if plan.jobs == 1 and plan.scheduler is None:
        yield from ((task, _result(task)) for task in tasks)
        return
    job = Job(_result, failed=str)
    pool = LocalWorkers(plan.jobs, job) if plan.scheduler is None else ClusterWorkers(plan.scheduler, job)
    with closing(pool):
        for task, result in pool.rows(iter(tasks)):
            yield task, result if isinstance(result, RecordingResult) else _failed(task, result)


def _failed(task: Measurement, reason: str) -> RecordingResult:
    return RecordingResult(task.who, "", "", "", reason, False, (), {}, {}, {}, (), {})


def _result(task: Measurement) -> RecordingResult:
    who = task.who
    path = task.root / who.file
    digest = ""
    key = ""
    try:
        if not path.resolve().is_relative_to(task.root.resolve()):
            raise InputError(f"{who.file} is not in the study's folder")
        digest = digest_of(path)
        key = key_of(task.root, who, digest, task.choices, task.options)
        kept = task.cache / f"{key[:24]}.npz"
        found = read_result(kept, key)
        if found is not None:
            return found
        result = measure_recording(task.root, who, task.choices, digest, task.options)
    except PlantarError as error:
        text = str(error).replace(f"{path}: ", "").replace(f"{task.root}{os.sep}", "")
        return replace(_failed(task, text), digest=digest, key=key)
    return write_result(result, kept)
