"""Study from a folder of recordings to tables and page."""

import json
import math
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import write_text
from plantar.common.table_writer import csv_text, mapping_rows
from plantar.common.version import VERSION
from plantar.errors import InputError, PlantarError
from plantar.formats import ReadOptions, formats
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.pages.figure_files import write_figures
from plantar.gait.analysis.results import as_data_frame
from plantar.gait.analysis.study.compare_conditions import Comparison, compare_conditions, outliers
from plantar.gait.analysis.study.one_recording import (
    RecordingResult,
    digest_of,
    key_of,
    measure_recording,
    read_result,
    write_result,
)
from plantar.gait.analysis.study.participants import Participation, not_read, read_participants
from plantar.gait.analysis.study.study_page import study_figures, study_page

_CACHE = "measured"  # Folder in the output folder that holds the result of each recording
_SKIPPED_FORMATS = ("image",)


@dataclass(frozen=True, eq=False)
class Study:
    """Measured study.

    `results`: one a recording; `error` has the reason of unmeasured ones; `comparisons`: every two conditions;
    `choices`: steps in the means, and events.
    """

    results: Sequence[RecordingResult]
    comparisons: Sequence[Comparison]
    choices: AnalysisOptions
    files: Sequence[str] = ()

    @cached_property
    def steps(self) -> dict[str, NDArray[Any]]:
        """Steps of all recordings as columns; NaN if unknown."""
        return _columns(_step_rows(self))

    def to_pandas(self) -> Any:
        """Steps as `pandas.DataFrame`; InputError without pandas."""
        return as_data_frame(self.steps)

    def report(self, path: str | os.PathLike[str] | None = None) -> str:
        """Study's page as one HTML text, also written to `path` if given."""
        with tempfile.TemporaryDirectory() as folder:
            figures = write_figures(study_figures(self.comparisons), Path(folder))
            page = study_page(self.summary(), self.results, self.comparisons, figures, "study")
        if path is not None:
            write_text(Path(path), page)
        return page

    def recordings(self) -> dict[str, NDArray[Any]]:
        """Every recording's feet as columns; an unmeasured recording is one row with its error."""
        return _columns(_recording_rows(self))

    def effects(self) -> dict[str, NDArray[Any]]:
        """Compared measures as columns: conditions, difference, effect size, intervals and probabilities."""
        return _columns(_effect_rows(self))

    def summary(self) -> dict[str, Any]:
        """Study as plain values of study.json."""
        return {
            "recordings": len(self.results),
            "measured": sum(not r.error for r in self.results),
            "notes": not_read({name: "" for r in self.results for name in r.who.more}),
            "errors": {r.who.file: r.error for r in self.results if r.error},
            "participants": len({r.who.participant for r in self.results if not r.error}),
            "conditions": list(dict.fromkeys(r.who.condition for r in self.results if r.who.condition)),
            "steps": sum(len(r.rows) for r in self.results),
            "options": asdict(self.choices),
            "version": VERSION,
            "comparisons": [_plain(c) for c in self.comparisons],
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
) -> Study:
    """Measure a folder's recordings; write steps.csv, recordings.csv, comparison.csv, study.json and study.html.

    Results of equal options and version are reused. Unreadable recordings are rows with the reason.

    Args:
        folder: With its subfolders.
        out: Output folder, made if needed.
        participants: Table of `read_participants`; nothing is compared without it.
        progress: As of `analyse_recording`, like `choices` and `figures`.
        options: Known of all files; the table overrides.

    Returns:
        The study.

    Raises:
        InputError: For no recordings, impossible values.
        FormatError: If the table is unreadable.
    """
    report = progress or (lambda fraction, text: None)
    root = Path(folder)
    target = Path(out)
    chosen = choices or AnalysisOptions()
    chosen.of_several("a study has")
    listed = [] if participants is None else read_participants(participants)
    # A file's own name may begin or end with blanks.
    listed = [who if (root / who.file).is_file() else replace(who, file=who.file.strip()) for who in listed]
    everything = [*listed, *_others(root, target, participants, {p.file for p in listed})]
    if not everything:
        raise InputError(
            f"{root}: no recording in it; allowed: a folder with files of the formats of plantar list formats"
        )
    cache = target / _CACHE
    cache.mkdir(parents=True, exist_ok=True)
    results = []
    for i, who in enumerate(everything):
        report(0.9 * i / len(everything), f"{i + 1} of {len(everything)}: {who.file}")
        results.append(_result(root, cache, who, chosen, options))
    report(0.9, "comparing")
    study = Study(results, compare_conditions(results), chosen)
    files = _write(study, target, root, figures)
    report(1.0, "done")
    return replace(study, files=files)


def _others(
    root: Path, target: Path, participants: str | os.PathLike[str] | None, listed: set[str]
) -> list[Participation]:
    endings = tuple(s for f in formats().values() if f.name not in _SKIPPED_FORMATS for s in f.suffixes)
    apart = {target.resolve()} if target.exists() else set()
    table = Path(participants).resolve() if participants is not None else None
    out: list[Participation] = []
    for path in sorted(root.rglob("*")):
        name = str(path.relative_to(root))
        hidden = any(part.startswith(".") for part in path.relative_to(root).parts)
        if name in listed or hidden or not path.is_file() or not path.name.lower().endswith(endings):
            continue
        if path.resolve() == table or apart & set(path.resolve().parents):
            continue
        out.append(Participation(file=name, participant=path.stem, listed=False))
    return out


def _result(
    root: Path, cache: Path, who: Participation, choices: AnalysisOptions, options: ReadOptions | None
) -> RecordingResult:
    path = root / who.file
    digest = ""
    key = ""
    try:
        if not path.resolve().is_relative_to(root.resolve()):
            raise InputError(f"{who.file} is not in the study's folder")
        digest = digest_of(path)
        key = key_of(root, who, digest, choices, options)
        kept = cache / f"{key[:24]}.npz"
        found = read_result(kept, key)
        if found is not None:
            return found
        result = measure_recording(root, who, choices, digest, options)
    except PlantarError as error:
        text = str(error).replace(f"{path}: ", "").replace(f"{root}{os.sep}", "")
        return RecordingResult(who, digest, key, "", text, False, (), {}, {}, {}, (), {})
    write_result(result, kept)
    return result


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


def _step_rows(study: Study) -> list[dict[str, Any]]:
    return [{**_identity(r), **row, **_provenance(study, r)} for r in study.results for row in r.rows]


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
    return [
        {"factor": c.factor, "a": c.a, "b": c.b, "measure": key, **asdict(effect)}
        for c in study.comparisons
        for key, effect in c.effects.items()
    ]


def _names(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    names: dict[str, None] = {}
    for row in rows:
        if not names.keys() >= row.keys():
            ends = [n for n in ("format", "version", "options", "sha256") if n in names]
            kept = [n for n in names if n not in ends]
            names = dict.fromkeys([*kept, *(n for n in row if n not in names and n not in ends), *ends])
            names |= dict.fromkeys(row)
    return list(names)


def _columns(rows: Sequence[Mapping[str, Any]]) -> dict[str, NDArray[Any]]:
    out: dict[str, NDArray[Any]] = {}
    for name in _names(rows):
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
    tables: Iterable[tuple[str, list[dict[str, Any]]]] = (
        ("steps.csv", _step_rows(study)),
        ("recordings.csv", _recording_rows(study)),
        ("comparison.csv", _effect_rows(study)),
    )
    for name, rows in tables:
        names = _names(rows)
        written.append(write_text(target / name, csv_text(names, mapping_rows(names, rows))))
    summary = study.summary()
    written.append(write_text(target / "study.json", json.dumps(summary, indent=1, allow_nan=False) + "\n"))
    if figures:
        drawn = write_figures(study_figures(study.comparisons), target)
        page = study_page(summary, study.results, study.comparisons, drawn, root.resolve().name)
        written += [write_text(target / "study.html", page), *(png for png, _ in drawn)]
        written += [png.with_suffix(".svg") for png, _ in drawn]
    return sorted(map(str, written))
