"""One recording of counts for a calibration, and what is known of the load meanwhile."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import array, numbers, own
from plantar.common.files.text_table import read_text_table
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.formats import ReadOptions, read_recording

TakeKind = Literal["zero", "press", "motion"]
"""What happens in a take: no load, known forces on parts of a sole, or a body that stands and moves on its soles."""

_FEWEST = 10  # frames
_BRIDGED = 0.1  # s between two counts of a taxel, up to which those that are missing lie on a line: a window of the fit


@dataclass(frozen=True, eq=False)
class Take:
    """Counts of one or both soles, k frames, and the load that they carry together.

    Attributes:
        kind: "zero": nothing touches the soles. "press": forces on parts of a sole, such as weights on single taxels or
            a roller on a sole that lies on a scale. "motion": a body that stands, leans and steps on these soles.
        time: Times (k,) in s, rising.
        counts: Counts (k, n) of each sole in it; for those that are missing (NaN) for up to 0.1 s a line is put.
        load: Force (k,) in N on all these soles together, NaN where unknown; a body's weight is one number. For a robot
            m (g + a) of its center of mass, by joints, IMU and mass. Left out for "zero".
        cop: Center of pressure (k, 2) in the sole frame in m of a sole while it carries alone; NaN where unknown.
        name: For messages.

    Raises:
        InputError: If shapes or values do not fit together.

    Example:
        >>> import numpy as np
        >>> still = Take("motion", np.arange(20) / 100, {"left": np.ones((20, 4))}, load=700.0)
        >>> still.load[:2].tolist()
        [700.0, 700.0]
    """

    kind: TakeKind
    time: NDArray[np.float64]
    counts: Mapping[Side, NDArray[np.float64]]
    load: NDArray[np.float64] | float | None = None
    cop: Mapping[Side, NDArray[np.float64]] = field(default_factory=dict)
    name: str = "take"

    def __post_init__(self) -> None:
        kept = self.__dict__  # past what keeps others from assigning
        if self.kind not in get_args(TakeKind):
            raise InputError(f"{self.name} is {self.kind!r}; allowed: {', '.join(get_args(TakeKind))}")
        time = own(array(self.time, f"{self.name}: time", ("any",), InputError))
        kept["time"] = time
        if len(time) < _FEWEST:
            raise InputError(f"{self.name} holds {len(time)} frames; allowed: {_FEWEST} or more")
        if not np.isfinite(time).all() or not (np.diff(time) > 0.0).all():
            raise InputError(f"{self.name}: times do not rise from frame to frame")
        if not self.counts:
            raise InputError(f"{self.name} holds no sole; allowed: counts of left, right or both")
        kept["counts"] = {side: self._counts(side, rows) for side, rows in self.counts.items()}
        kept["load"] = self._load()
        kept["cop"] = {side: self._cop(side, places) for side, places in self.cop.items()}

    @property
    def rate(self) -> float:
        """Frames a second."""
        return float(1.0 / np.median(np.diff(self.time)))

    def _counts(self, side: Side, rows: object) -> NDArray[np.float64]:
        if side not in SIDES:
            raise InputError(f"{self.name} holds counts of {side!r}; allowed: left, right")
        what = f"{self.name}: counts of the {side} sole"
        found = array(rows, what, (len(self.time), "any"), InputError)
        if np.isinf(found).any():
            raise InputError(f"{what} hold a value that is infinite")
        return own(_bridged(self.time, found))

    def _load(self) -> NDArray[np.float64] | None:
        if self.load is None:
            if self.kind != "zero":
                raise InputError(f"{self.name} needs a load in N; allowed without: kind zero")
            return None
        what = f"{self.name}: load"
        given = numbers(self.load, what, InputError)
        found = (
            np.full(len(self.time), float(given))
            if given.ndim == 0
            else array(given, what, self.time.shape, InputError)
        )
        known = found[np.isfinite(found)]
        if not len(known) or np.isinf(found).any() or not known.max() > 0.0:
            raise InputError(f"{what} holds no force above 0 N")
        return own(found)

    def _cop(self, side: Side, places: object) -> NDArray[np.float64]:
        if side not in self.counts:
            raise InputError(f"{self.name} gives a center of pressure of the {side} sole, of which it has no counts")
        what = f"{self.name}: center of pressure of the {side} sole"
        found = own(array(places, what, (len(self.time), 2), InputError))
        if np.nanmax(np.abs(found), initial=0.0) > 1.0:
            raise InputError(f"{what} lies more than 1 m from the sole's origin")
        return found


def _bridged(time: NDArray[np.float64], counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """Counts (k, n) with lines over what is missing for a short time."""
    missing = np.isnan(counts)
    out = counts.copy()
    for taxel in np.flatnonzero(missing.any(axis=0) & ~missing.all(axis=0)):
        known = np.flatnonzero(~missing[:, taxel])
        lost = np.flatnonzero(missing[:, taxel])
        after = np.searchsorted(known, lost)
        inside = (after > 0) & (after < len(known))
        between = time[known[after[inside]]] - time[known[after[inside] - 1]]
        short = lost[inside][between <= _BRIDGED]
        out[short, taxel] = np.interp(time[short], time[known], counts[known, taxel])
    return out


def read_take(
    kind: TakeKind,
    recording: str | os.PathLike[str],
    load: float | None = None,
    reference: str | os.PathLike[str] | None = None,
    skipped: int = 0,
) -> Take:
    """A take of a recording of counts.

    Args:
        kind: "zero", "press" or "motion".
        recording: File of any known format; its values are taken as counts.
        load: Constant force in N on its soles, such as the weight of a person.
        reference: CSV table with the columns time and force, and for soles that carry alone left_x, left_y, right_x and
            right_y, in s, N and m, on the recording's clock; interpolated, no farther than its rows reach.
        skipped: Frames at its begin that are left out.

    Returns:
        The take, named as its file.

    Raises:
        InputError: If load and reference are both given, or neither where one is needed.
        FormatError: If a file is unreadable.
    """
    found = read_recording(recording, options=ReadOptions(unit="raw", calibrated=False))
    name = Path(recording).name
    if load is not None and reference is not None:
        raise InputError(f"{name} has a weight and a reference; allowed: one of them")
    time = found.time[skipped:]
    counts = {side: foot.force[skipped:] for side, foot in found.feet.items()}
    if kind == "zero" or reference is None:
        return Take(kind, time, counts, load if kind != "zero" else None, name=name)
    table = _table(reference)
    at = {column: np.interp(time, table["time"], rows, np.nan, np.nan) for column, rows in table.items()}
    cop = {
        side: np.column_stack([at[f"{side}_x"], at[f"{side}_y"]])
        for side in counts
        if f"{side}_x" in at and f"{side}_y" in at
    }
    return Take(kind, time, counts, at["force"], cop, name)


def _table(path: str | os.PathLike[str]) -> dict[str, NDArray[np.float64]]:
    known = ("time", "force", "left_x", "left_y", "right_x", "right_y")
    table = read_text_table(path, InputError)
    names = table.names
    if not {"time", "force"} <= set(names) <= set(known):
        allowed = f"time and force, and {', '.join(known[2:])}"
        raise InputError(f"{path}: columns are {', '.join(names)[:80]}; allowed: {allowed}")
    values = np.full((len(table.rows), len(names)), np.nan)
    for i, (line, cells) in enumerate(table.rows):
        if len(cells) != len(names):
            raise InputError(f"{path}: line {line} has {len(cells)} cells; allowed: {len(names)}")
        try:
            values[i] = [float(cell) if cell.strip() else np.nan for cell in cells]
        except ValueError as error:
            raise InputError(f"{path}: line {line}: {error}; allowed: numbers, empty where unknown") from None
    if len(values) < 2 or not (np.diff(values[:, names.index("time")]) > 0.0).all():
        raise InputError(f"{path}: times do not rise over two rows or more")
    return {name: values[:, i] for i, name in enumerate(names)}
