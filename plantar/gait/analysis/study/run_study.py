"""Study from a folder of recordings to tables and page."""

import json
import math
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import write_text
from plantar.common.table_writer import csv_text, mapping_rows
from plantar.common.version import VERSION
from plantar.errors import InputError
from plantar.formats import ReadOptions, formats
from plantar.formats.step_table import masses_of_people, people_of_steps
from plantar.formats.walkway import one_of_each_walk
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.pages.figure_files import write_figures
from plantar.gait.analysis.results import as_data_frame
from plantar.gait.analysis.study.compare_conditions import (
    Comparison,
    compare_changes,
    compare_conditions,
    outliers,
)
from plantar.gait.analysis.study.measured_recordings import Measurement, measured
from plantar.gait.analysis.study.measured_table import check_names
from plantar.gait.analysis.study.mixed_models import MixedEffect, mixed_effects
from plantar.gait.analysis.study.one_against_group import OneAgainstGroup, one_against_group
from plantar.gait.analysis.study.one_recording import (
    RecordingResult,
)
from plantar.gait.analysis.study.paper_table import paper_text
from plantar.gait.analysis.study.participants import Participation, not_read, read_participants
from plantar.gait.analysis.study.patient_page import patient_figures, patient_page
from plantar.gait.analysis.study.reliability import Agreement, Reliability, agreements, reliabilities
from plantar.gait.analysis.study.sample_size import people_needed
from plantar.gait.analysis.study.stored_steps import TEXTS, StoredRows, columns_of, write_parquet, write_steps
from plantar.gait.analysis.study.study_options import StudyOptions
from plantar.gait.analysis.study.study_page import StudyParts, study_figures, study_page
from plantar.gait.analysis.study.workbook import write_workbook

_CACHE = "measured"  # Folder in the output folder that holds the result of each recording
_SKIPPED_FORMATS = ("image",)
_PROVENANCE = ("format", "version", "options", "sha256")  # columns at the end of tables
_ALWAYS = ("recordings", "comparison")  # Tables that are written without rows, too


@dataclass(frozen=True, eq=False, repr=False)
class Study:
    """Measured study.

    `results`: one a recording; `error` has the reason of unmeasured ones; `comparisons`: every two conditions;
    `choices`: steps in the means, and events.
    """

    results: Sequence[RecordingResult]
    comparisons: Sequence[Comparison]
    choices: AnalysisOptions
    files: Sequence[str] = ()
    plan: StudyOptions = field(default_factory=StudyOptions)

    def __repr__(self) -> str:
        measured = [result for result in self.results if not result.error]
        people = len({result.who.participant for result in measured})
        pairs = ", ".join(f"{c.a} with {c.b}" for c in self.comparisons) or "nothing"
        return (
            f"Study({len(measured)} of {len(self.results)} recordings measured, {people} participants, "
            f"{sum(len(result.rows) for result in measured)} steps; compared: {pairs})"
        )

    def _repr_html_(self) -> str:
        from plantar.plotting import html_of

        figures = {name: figure for name, figure, _ in study_figures(self.comparisons[:1])}
        return html_of(figures.get("effects"), repr(self))

    @cached_property
    def changes(self) -> list[Comparison]:
        """Of every two factors, whether the difference of the first depends on the second."""
        return [c for one, two in combinations(self.plan.factors, 2) for c in compare_changes(self.results, one, two)]

    @cached_property
    def reliability(self) -> dict[str, dict[str, Reliability]]:
        """Reliability of each measure over repeated trials, by condition."""
        return reliabilities(self.results)

    @cached_property
    def agreement(self) -> tuple[tuple[str, str], Mapping[str, Agreement]]:
        """The two devices, and their agreement by measure."""
        return agreements(self.results, self.plan.devices) if self.plan.devices else (("", ""), {})

    @cached_property
    def patient(self) -> OneAgainstGroup | None:
        """The chosen participant against the others."""
        if self.plan.patient is None:
            return None
        return one_against_group(self.results, self.plan.patient, self.plan.norm)

    @cached_property
    def mixed(self) -> list[MixedEffect]:
        """Effects of the factors by mixed models of single steps, if chosen."""
        if not self.plan.mixed:
            return []
        return [e for factor in self.plan.factors for e in mixed_effects(self.results, factor, self.plan.covariates)]

    @cached_property
    def steps(self) -> dict[str, NDArray[Any]]:
        """Steps of all recordings as columns; NaN if unknown."""
        return _columns(list(self.step_rows()))

    def step_rows(self) -> Iterator[dict[str, Any]]:
        """Yields a row of each step, one recording after another: all of a study of any size are never held."""
        for before, rows, after in _step_parts(self):
            for row in rows:
                yield {**before, **row, **after}

    def step_columns(self) -> list[str]:
        """Columns of `step_rows`."""
        heads = (dict.fromkeys([*before, *_names(rows), *after]) for before, rows, after in _step_parts(self))
        return columns_of(heads, _PROVENANCE)

    def to_pandas(self) -> Any:
        """Steps as `pandas.DataFrame`; InputError without pandas."""
        return as_data_frame(self.steps)

    def report(self, path: str | os.PathLike[str] | None = None) -> str:
        """Study's page as one HTML text, also written to `path` if given."""
        with tempfile.TemporaryDirectory() as folder:
            figures = write_figures(study_figures(self.comparisons), Path(folder))
            page = study_page(self.summary(), self.results, self.comparisons, figures, "study", self.more())
        if path is not None:
            write_text(Path(path), page)
        return page

    def recordings(self) -> dict[str, NDArray[Any]]:
        """Every recording's feet as columns; an unmeasured recording is one row with its error."""
        return _columns(_recording_rows(self))

    def effects(self) -> dict[str, NDArray[Any]]:
        """Compared measures as columns: conditions, difference, effect size, intervals and probabilities."""
        return _columns(_effect_rows(self))

    def more(self) -> StudyParts:
        """What the page has beside comparisons."""
        return StudyParts(self.changes, self.reliability, self.agreement, self.mixed)

    def tables(self) -> dict[str, list[dict[str, Any]]]:
        """Rows of the study's tables by name, but of single steps; those without rows are left out."""
        devices, agreed = self.agreement
        patient = self.patient
        known = {
            "recordings": _recording_rows(self),
            "comparison": _effect_rows(self),
            "changes": [row for c in self.changes for row in _rows_of(c)],
            "reliability": [
                {"condition": condition, "measure": key, **asdict(found)}
                for condition, rows in self.reliability.items()
                for key, found in rows.items()
            ],
            "agreement": [
                {"a": devices[0], "b": devices[1], "measure": key, **asdict(found)} for key, found in agreed.items()
            ],
            "mixed": [asdict(effect) for effect in self.mixed],
            "patient": [
                {"participant": patient.participant if patient else "", "side": side, "measure": key, **asdict(found)}
                for side, rows in (() if patient is None else patient.measures.items())
                for key, found in rows.items()
            ],
        }
        return {name: rows for name, rows in known.items() if rows or name in _ALWAYS}

    def summary(self) -> dict[str, Any]:
        """Study as plain values of study.json."""
        chosen = {*self.plan.factors, *self.plan.covariates, self.plan.devices}
        return {
            "recordings": len(self.results),
            "measured": sum(not r.error for r in self.results),
            "notes": not_read({name: "" for r in self.results for name in r.who.more if name not in chosen}),
            "errors": {r.who.file: r.error for r in self.results if r.error},
            "participants": len({r.who.participant for r in self.results if not r.error}),
            "conditions": list(dict.fromkeys(r.who.condition for r in self.results if r.who.condition)),
            "steps": sum(len(r.rows) for r in self.results),
            "options": asdict(self.choices),
            "plan": {key: value for key, value in asdict(self.plan).items() if key not in ("jobs", "scheduler")},
            "version": VERSION,
            "comparisons": [_plain(c) for c in self.comparisons],
            "changes": [_plain(c) for c in self.changes],
            "outliers": [o._asdict() for o in outliers(self.results)],
        }


def run_study(
    folder: str | os.PathLike[str],
    out: str | os.PathLike[str],
    participants: str | os.PathLike[str] | None = None,
    progress: Callable[[float, str], None] | None = None,
    *,
    choices: AnalysisOptions | None = None,
    options: ReadOptions | None = None,
    figures: bool = True,
    plan: StudyOptions | None = None,
) -> Study:
    """Measure a folder's recordings; write steps.csv, recordings.csv, comparison.csv, study.json and study.html.

    Where the study has them, also paper.md (tables of a paper), changes.csv, reliability.csv, agreement.csv, mixed.csv,
    patient.csv, patient.html and study.xlsx. Results of equal options and version are reused. Unreadable recordings are
    rows with the reason.

    Args:
        folder: With its subfolders; or one file, which is measured alone.
        out: Output folder, made if needed.
        participants: Table of `read_participants`; nothing is compared without it.
        progress: As of `analyse_recording`, like `choices` and `figures`.
        options: Known of all files; the table overrides.
        plan: What is compared and allowed for.

    Returns:
        The study.

    Raises:
        InputError: For no recordings, impossible values.
        FormatError: If the table is unreadable.
    """
    report = progress or (lambda fraction, text: None)
    root = Path(folder)
    single = [] if root.is_dir() else [_unlisted(root.parent, root)]
    root = root.parent if single else root
    target = Path(out)
    chosen = choices or AnalysisOptions()
    planned = plan or StudyOptions()
    chosen.of_several("a study has")
    listed = [] if participants is None else read_participants(participants)
    # A file's own name may begin or end with blanks.
    listed = [who if (root / who.file).is_file() else replace(who, file=who.file.strip()) for who in listed]
    everything = single or [*listed, *_others(root, target, participants, {p.file for p in listed})]
    if not everything:
        raise InputError(
            f"{root}: no recording in it; allowed: a folder with files of the formats of plantar list formats"
        )
    cache = target / _CACHE
    cache.mkdir(parents=True, exist_ok=True)
    tasks = [Measurement(root, cache, who, chosen, options) for who in everything]
    found: dict[Measurement, RecordingResult] = {}
    for task, result in measured(tasks, planned):
        found[task] = result
        report(0.9 * len(found) / len(tasks), f"{len(found)} of {len(tasks)}: {task.who.file}")
    results = [found[task] for task in tasks]
    report(0.9, "comparing")
    if participants is not None or any(who.condition for who in everything):
        check_names(results, planned.factors if planned.factors != ("condition",) else (), planned.covariates)
    comparisons = [
        comparison
        for factor in planned.factors
        for comparison in compare_conditions(results, factor, planned.covariates, planned.margin_percent)
    ]
    study = Study(results, comparisons, chosen, plan=planned)
    files = _write(study, target, root, figures)
    report(1.0, "done")
    return replace(study, files=files)


def _others(
    root: Path, target: Path, participants: str | os.PathLike[str] | None, listed: set[str]
) -> list[Participation]:
    endings = tuple(s for f in formats().values() if f.name not in _SKIPPED_FORMATS for s in f.suffixes)
    apart = {target.resolve()} if target.exists() else set()
    table = Path(participants).resolve() if participants is not None else None
    out: list[Path] = []
    for path in sorted(root.rglob("*")):
        name = str(path.relative_to(root))
        hidden = any(part.startswith(".") for part in path.relative_to(root).parts)
        if name in listed or hidden or not path.is_file() or not path.name.lower().endswith(endings):
            continue
        if path.resolve() == table or apart & set(path.resolve().parents):
            continue
        out.append(path)
    return [_unlisted(root, path) for path in one_of_each_walk(out)]


def _unlisted(root: Path, path: Path) -> Participation:
    """A file that no table lists: of the person and footwear that its table of footsteps states, or of its own name."""
    name = str(path.relative_to(root))
    stated = people_of_steps(path)
    if "participant" not in stated:
        return Participation(file=name, participant=path.stem, listed=False)
    who = stated["participant"]
    more = {key: value for key, value in stated.items() if key == "speed"}
    mass = masses_of_people(path).get(who)
    return Participation(name, who, stated.get("footwear", ""), mass, more=more, listed=False)


def _identity(result: RecordingResult) -> dict[str, Any]:
    who = result.who
    return {"recording": who.file, "participant": who.participant, "condition": who.condition, **who.more}


def _provenance(study: Study, result: RecordingResult) -> dict[str, Any]:
    return {
        "format": result.format,
        "version": VERSION,
        "options": json.dumps(asdict(study.choices), sort_keys=True),
        "sha256": result.digest,
    }


def _step_parts(study: Study) -> Iterator[tuple[dict[str, Any], Sequence[Mapping[str, Any]], dict[str, Any]]]:
    """What stands before each step of a recording, the steps, and what stands after each; recordings without are left
    out."""
    return ((_identity(r), r.rows, _provenance(study, r)) for r in study.results if len(r.rows))


def _names(rows: Sequence[Mapping[str, Any]]) -> Sequence[str]:
    return rows.names if isinstance(rows, StoredRows) else columns_of(rows, ())


def _recording_rows(study: Study) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = []
    for result in study.results:
        who = {"mass_kg": result.who.mass_kg, "foot_length_m": result.who.foot_length_m}
        ends = {"warnings": " | ".join(result.warnings), "error": result.error, **_provenance(study, result)}
        if result.error:
            rows.append({**_identity(result), "side": "", "steps": 0, **who, **ends})
        for side, means in result.feet.items():
            walk = {f"walk_{key}": value for key, value in result.walk.items()}
            rows.append(
                {**_identity(result), "side": side, "steps": int(means["steps"]), **who, **means, **walk, **ends}
            )
    return rows


def _effect_rows(study: Study) -> list[dict[str, Any]]:
    return [row for c in study.comparisons for row in _rows_of(c)]


def _rows_of(comparison: Comparison) -> list[dict[str, Any]]:
    names = {"factor": comparison.factor, "a": comparison.a, "b": comparison.b}
    return [
        {**names, "measure": key, **asdict(effect), "people_for_80_percent": people_needed(effect)}
        for key, effect in comparison.effects.items()
    ]


def _columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, NDArray[Any]]:
    out: dict[str, NDArray[Any]] = {}
    for name in columns_of(rows, _PROVENANCE):
        values = [row.get(name) for row in rows]
        texts = any(isinstance(v, str) for v in values)
        out[name] = np.array([("" if v is None else v) if texts else math.nan if v is None else v for v in values])
    return out


def _plain(comparison: Comparison) -> dict[str, Any]:
    effects = {
        key: {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in asdict(effect).items()}
        for key, effect in comparison.effects.items()
    }
    out = {
        key: getattr(comparison, key)
        for key in ("factor", "a", "b", "paired", "note", "doubts", "levels", "covariates")
    }
    for name, test in (("curve", comparison.curve_test), ("map", comparison.map_test)):
        if test is not None:
            out[name] = {
                "threshold": test.threshold,
                "permutations": test.permutations,
                "clusters": [
                    {"p": p, "places": np.flatnonzero(test.clusters == number).tolist()}
                    for number, p in enumerate(test.cluster_p, 1)
                ],
            }
    omnibus = {key: asdict(test) for key, test in comparison.omnibus.items()}
    return {**out, "effects": effects, "any_difference": omnibus}


def _write(study: Study, target: Path, root: Path, figures: bool) -> list[str]:
    written: list[Path] = []
    tables = study.tables()
    for name, rows in tables.items():
        names = columns_of(rows, _PROVENANCE)
        written.append(write_text(target / f"{name}.csv", csv_text(names, mapping_rows(names, rows))))
    columns = study.step_columns()
    if study.plan.parquet:
        texts = {*TEXTS, *_PROVENANCE, *(name for r in study.results for name in _identity(r))}
        written.append(write_parquet(target / "steps.parquet", columns, study.step_rows(), texts))
    else:
        written.append(write_steps(target / "steps.csv", columns, _step_parts(study)))
    if study.plan.workbook:
        steps = {"steps": (columns, list(study.step_rows()))}
        sheets = steps | {name: (columns_of(rows, _PROVENANCE), rows) for name, rows in tables.items()}
        written.append(write_workbook(target / "study.xlsx", sheets))
    if study.comparisons:
        written.append(write_text(target / "paper.md", paper_text(study.comparisons)))
    summary = study.summary()
    written.append(write_text(target / "study.json", json.dumps(summary, indent=1, allow_nan=False) + "\n"))
    if figures:
        drawn = write_figures(study_figures(study.comparisons), target)
        page = study_page(summary, study.results, study.comparisons, drawn, root.resolve().name, study.more())
        written += [write_text(target / "study.html", page), *(png for png, _ in drawn)]
        written += [png.with_suffix(".svg") for png, _ in drawn]
        if study.patient is not None:
            own = write_figures(patient_figures(study.patient), target)
            written += [write_text(target / "patient.html", patient_page(study.patient, own, VERSION))]
            written += [file for png, _ in own for file in (png, png.with_suffix(".svg"))]
    return sorted(map(str, written))
