"""One recording of a study: steps, feet, mean curves and sole maps."""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import replacing
from plantar.common.files.input_file import sha256_of
from plantar.common.gravity import GRAVITY
from plantar.common.sides import Side
from plantar.common.version import VERSION
from plantar.errors import FormatError
from plantar.formats import ReadOptions
from plantar.formats.walkway import is_walkway
from plantar.gait.analysis.analyse_one import analyse_one, with_layout
from plantar.gait.analysis.compare import sensor_of
from plantar.gait.analysis.measures import MEASURES, REGION_MEASURES, in_percent, naming
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.pages.force_figures import stance_curves
from plantar.gait.analysis.results import Analysis
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.study.participants import Participation
from plantar.gait.analysis.study.stored_steps import StoredRows, in_lines
from plantar.gait.analysis.subject import Subject
from plantar.gait.analysis.summary import gait_of_feet
from plantar.gait.analysis.walkway.measured_walkway import SENSOR, measure_walkway
from plantar.layouts.layout_file import layout_to_dict

GRID = (36, 14)
"""Places along and across a sole at which maps are compared: about 8 mm, the pitch of in-shoe sensors."""

_ARRAYS = ("curve_", "map_")  # in a stored result, before the side


@dataclass(frozen=True, eq=False)
class RecordingResult:
    """Result of one recording in a study.

    Attributes:
        digest: File's SHA-256.
        key: Digest of file, options and version (`key_of`).
        format: Format's name; empty if unreadable.
        error: Why not measured, or empty.
        rows: A row a step, with every measure, of regions as "region.measure"; None if unknown. Of a stored result they
            are read when they are asked for.
        feet: Each foot's mean of each measure, and "steps" used.
        curves: Each foot's mean vertical force (101,) in N over the stance.
        maps: Each foot's mean maximum pressure `GRID` in Pa, heel to toes, lateral to medial, NaN off the sole.
        warnings: What was assumed.
    """

    who: Participation
    digest: str
    key: str
    format: str
    error: str
    raw: bool
    rows: Sequence[Mapping[str, Any]]
    feet: Mapping[Side, Mapping[str, float]]
    curves: Mapping[Side, NDArray[np.float64]]
    maps: Mapping[Side, NDArray[np.float64]]
    warnings: tuple[str, ...]
    walk: Mapping[str, float | None]
    sensor: tuple[str, float] = ("insoles", 0.0)


def digest_of(path: Path) -> str:
    """SHA-256 of a file in hexadecimal; empty if unreadable."""
    try:
        return sha256_of(path, FormatError)
    except (OSError, FormatError):
        return ""


def key_of(
    folder: Path, who: Participation, digest: str, choices: AnalysisOptions, options: ReadOptions | None = None
) -> str:
    """Returns digest of what decides a result of participation who: file digest, choices, options, layouts, version.

    Layout files in the study's folder count by content.
    """
    given = options or ReadOptions()
    known = (given.unit, given.rate_hz, given.side, given.insole_size)
    layouts = (
        layout_to_dict(given.layout) if given.layout else "",
        digest_of(folder / who.layout) if who.layout else "",
    )
    decisive = [VERSION, digest, asdict(who), asdict(choices), known, layouts]
    return hashlib.sha256(json.dumps(decisive).encode()).hexdigest()


def measure_recording(
    folder: Path, who: Participation, choices: AnalysisOptions, digest: str, options: ReadOptions | None = None
) -> RecordingResult:
    """Returns result of one recording in a study's folder.

    Args:
        digest: SHA-256 of the file.
        options: Known of all files; the table overrides. PlantarError if unreadable.
    """
    given = options or ReadOptions()
    known = ReadOptions(
        layout=given.layout,
        unit=who.unit or given.unit,
        rate_hz=who.rate_hz or given.rate_hz,
        side=who.side or given.side,  # type: ignore[arg-type]
        insole_size=who.insole_size or given.insole_size,
    )
    known = with_layout(known, folder / who.layout) if who.layout else known
    if is_walkway(folder / who.file):
        return _of_walkway(folder, who, choices, digest, known, key_of(folder, who, digest, choices, options))
    subject = Subject(who.participant, who.mass_kg, who.foot_length_m)
    analysis = analyse_one(folder / who.file, None, known, choices=choices, subject=subject)
    recording = analysis.recording
    rows = _rows(analysis, who)
    return RecordingResult(
        who=who,
        digest=digest,
        key=key_of(folder, who, digest, choices, options),
        format=recording.format,
        error="",
        raw=recording.raw,
        rows=tuple(rows),
        feet={side: _means(rows, side) for side in analysis.feet},
        curves={s: stance_curves(recording, g).mean(axis=0) for s, g in analysis.feet.items() if g.used},
        maps={s: found for s, g in analysis.feet.items() if (found := _map(analysis, g)) is not None},
        warnings=tuple(analysis.metrics["warnings"]),
        walk={k: v for k, v in analysis.metrics["gait"].items() if k != "symmetry_percent"},
        sensor=sensor_of(recording),
    )


def _of_walkway(
    folder: Path, who: Participation, choices: AnalysisOptions, digest: str, known: ReadOptions, key: str
) -> RecordingResult:
    found = measure_walkway(folder / who.file, known, choices, GRID)
    rows = _step_rows(found.feet, who)
    return RecordingResult(
        who=who,
        digest=digest,
        key=key,
        format="walkway",
        error="",
        raw=False,
        rows=tuple(rows),
        feet={side: _means(rows, side) for side in found.feet},
        curves=found.curves,
        maps=found.maps,
        warnings=found.warnings,
        walk=dict(gait_of_feet(found.feet)),
        sensor=SENSOR,
    )


def _step_rows(feet: Mapping[Side, FootGait], who: Participation) -> list[dict[str, Any]]:
    """Rows of steps in time order, as `_rows` of an analysis."""
    steps = sorted((step for gait in feet.values() for step in gait.steps), key=lambda s: s.heel_strike_s)
    regions = dict.fromkeys(name for step in steps for name in step.regions)
    out = []
    for step in steps:
        known: dict[str, float | None] = {key: _known(step.measures.get(key)) for key in MEASURES}
        for region in regions:
            own = step.regions.get(region, {})
            known |= {f"{region}.{key}": own.get(key) for key in REGION_MEASURES}
        head = {"side": step.side, "step": step.number, "used": int(step.used), "note": step.unused or step.odd}
        times = {"heel_strike_s": step.heel_strike_s, "toe_off_s": step.toe_off_s}
        out.append({**head, **times, **known, **normalised(known, who)})
    return out


def _known(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else value


def _rows(analysis: Analysis, who: Participation) -> list[dict[str, Any]]:
    columns = analysis.steps
    keys = [key for key in columns if key not in ("side", "number", "used", "note", "heel_strike_s", "toe_off_s")]
    regions = {(s.side, s.number): s.regions for gait in analysis.feet.values() for s in gait.steps}
    names = dict.fromkeys(name for own in regions.values() for name in own)
    name_of = naming(analysis.recording.raw)
    out = []
    for values in zip(*(column.tolist() for column in columns.values()), strict=True):
        step = dict(zip(columns, values, strict=True))
        known = {key: step[key] if np.isfinite(step[key]) else None for key in keys}
        head = {"side": step["side"], "step": step["number"], "used": int(step["used"]), "note": step["note"]}
        times = {key: step[key] for key in ("heel_strike_s", "toe_off_s")}
        own = regions[step["side"], step["number"]]
        for region in names:
            known |= {f"{region}.{name_of(key)}": own.get(region, {}).get(key) for key in REGION_MEASURES}
        out.append({**head, **times, **known, **normalised(known, who)})
    return out


def normalised(measures: Mapping[str, float | None], who: Participation) -> dict[str, float | None]:
    """Returns measures in percent of body weight and foot length, where the participation (who) has these.

    Keys end in `_percent_bw`, `_percent_bw_s` (impulses), `_percent_bw_per_s` (rates) and `_percent_foot`.

    Example:
        >>> normalised({"peak_force_N": 784.8}, Participation("a.asc", "a", mass_kg=80.0))
        {'peak_force_percent_bw': 100.0}
    """
    out: dict[str, float | None] = {}
    for key, value in measures.items():
        percent = in_percent(key)
        whole = (
            who.foot_length_m if percent.endswith("_foot") else None if who.mass_kg is None else who.mass_kg * GRAVITY
        )
        if percent and whole is not None:
            out[percent] = None if value is None else round(100.0 * value / whole, 9)
    return out


def _means(rows: list[dict[str, Any]], side: Side) -> dict[str, float]:
    own = [row for row in rows if row["side"] == side and row["used"]]
    out: dict[str, float] = {"steps": float(len(own))}
    for key in own[0] if own else ():
        if key in ("side", "step", "used", "note", "heel_strike_s", "toe_off_s"):
            continue
        values = [row[key] for row in own if row[key] is not None]
        if values:
            out[key] = float(np.mean(values))
    return out


def _map(analysis: Analysis, gait: FootGait) -> NDArray[np.float64] | None:
    layout = gait.foot.layout
    picture = gait.picture
    if layout is None or picture is None or not gait.used:
        return None
    if analysis.recording.kind == "platform":
        print_ = gait.used[0].footprint
        if print_ is None:
            return None
        points = print_.centres
        values = print_.pressure
        corners = print_.rings.reshape(-1, 2)
    else:
        medial = np.array([1.0, 1.0 if gait.foot.side == "right" else -1.0])
        points = layout.positions[:, :2] * medial
        values = picture
        corners = layout.outline * medial
    return sampled(points, values, corners)


def sampled(
    points: NDArray[np.float64], values: NDArray[np.float64], corners: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Returns map of cell values at the places of `GRID`: nearest cell's, or NaN if far.

    `points`: cell centres (k, 2), forward and medial; `values`: their values (k,); `corners`: points (m, 2) spanning
    the sole.
    """
    low = corners.min(axis=0)
    extent = np.ptp(corners, axis=0)
    along = low[0] + (np.arange(GRID[0]) + 0.5) / GRID[0] * extent[0]
    across = low[1] + (np.arange(GRID[1]) + 0.5) / GRID[1] * extent[1]
    places = np.array([[u, v] for u in along for v in across])
    squares = ((places[:, None, :] - points[None]) ** 2).sum(axis=2)
    nearest = squares.argmin(axis=1)
    between = ((points[:, None, :] - points[None]) ** 2).sum(axis=2)
    np.fill_diagonal(between, np.inf)
    beside = np.sort(between, axis=1)[:, min(2, len(points) - 1)]  # to the third nearest: cells are longer than wide
    found = np.where(squares.min(axis=1) <= 0.6 * float(np.median(beside)), values[nearest], np.nan)
    return np.asarray(found.reshape(GRID))


def write_result(result: RecordingResult, path: Path) -> RecordingResult:
    """Store a result at a path (.npz) so that a stopped study can continue; returns it with its steps left there."""
    plain = {f.name: getattr(result, f.name) for f in fields(result) if f.name not in ("curves", "maps", "rows")}
    parts = zip(_ARRAYS, (result.curves, result.maps), strict=True)
    arrays: dict[str, Any] = {f"{part}{side}": values for part, of in parts for side, values in of.items()}
    names, lines = in_lines(result.rows)
    texts = {"text": {**plain, "rows": (names, len(lines))}, "rows": lines}
    stored: dict[str, Any] = {
        name: np.frombuffer(json.dumps(held, default=asdict).encode(), np.uint8) for name, held in texts.items()
    }
    with replacing(path) as temporary, temporary.open("wb") as stream:
        np.savez_compressed(stream, **stored, **arrays)
    return replace(result, rows=StoredRows(path, names, len(lines)))


def read_result(path: Path, key: str) -> RecordingResult | None:
    """Returns stored result at a path, its steps left there; None if missing, damaged, or of another key."""
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as held:
            plain = json.loads(held["text"].tobytes())
            curves, maps = ({n[len(p) :]: held[n] for n in held.files if n.startswith(p)} for p in _ARRAYS)
            whole = "rows" in held.files
        plain |= {"who": Participation(**plain["who"])} | {k: tuple(plain[k]) for k in ("warnings", "sensor")}
        names, count = plain["rows"]
        plain["rows"] = StoredRows(path, names, count)
        found = RecordingResult(**plain, curves=curves, maps=maps)
    except Exception:  # a file that was cut short may raise anything; measuring again is always right
        return None
    return found if whole and found.key == key else None
