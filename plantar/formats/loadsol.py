"""loadsol insoles (novel) whose export names sensor and zone of each column: "PGV1-L::heel" above "Force[N]".

Each insole has one to three zones (heel, medial, lateral), their total, and an IMU; each has its own clock. The zones
have no places in the file: forces only. After exports of the loadsol app (zpomarat/loadsol, BSD-2).
"""

import re
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import on_one_time
from plantar.formats.text import head_text, open_text, table_of_lines
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, sampling

_SENSOR = re.compile(r"(?P<name>[^\t:]+-(?P<side>[LR]))(?:::(?P<zone>\w+))?")
_NAMES = re.compile(r"-[LR]::\w+[^\n]*\n\s*Time\[secs\]([\t,;])Force\[N\]")  # above units, between tabs or commas
_HEAD = 20  # Lines that may stand above the names
_LOST = -1.0  # N, in all zones of a frame that did not arrive
_APART = 0.02  # Share of the total by which its zones' sum may differ: they are rounded


def _recognises(head: bytes) -> bool:
    return _NAMES.search(head_text(head)) is not None


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    with open_text(path) as stream:
        above = ""
        for line in islice(stream, _HEAD):
            if line.startswith("Time[secs]"):
                delimiter = line.removeprefix("Time[secs]")[:1]
                sensors = above.rstrip("\n").split(delimiter)
                units = line.rstrip("\n").split(delimiter)
                break
            above = line
        else:
            raise FormatError("no line of names and units: Time[secs], Force[N]")
        rows = (row.rstrip("\n") for row in stream if row.strip())
        width = len([unit for unit in units if unit.strip()])
        table = table_of_lines(path, rows, delimiter, width, warnings)
    columns = _columns(sensors, units[:width])
    feet = {
        side: (table[:, clock], table[:, [*zones.values(), total]]) for side, (clock, zones, total) in columns.items()
    }
    for side, (_, part) in feet.items():
        lost = (part[:, :-1] == _LOST).all(axis=1)
        part[lost] = np.nan
        if lost.any():
            warnings.append(
                f"{int(lost.sum())} of {len(lost)} frames of the {side} insole ({100.0 * lost.mean():.2g} %) were "
                "lost on the way to the app, which writes -1: they count as not measured"
            )
    time, values = on_one_time(feet, warnings)
    time, rate, notes = sampling(time, None, options.rate_hz)
    for side, (_, zones, _) in columns.items():
        _check_total(side, list(zones), values[side], warnings)
    warnings.append("the zones have no places in the file: forces only, no pressures and centres of pressure")
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet={side: FootRecording(side, v[:, :-1], None, total=v[:, -1]) for side, v in values.items()},
        metadata={"zones": {side: list(zones) for side, (_, zones, _) in columns.items()}, "unit": "N"},
        warnings=(*warnings, *notes),
    )


def _columns(sensors: list[str], units: list[str]) -> dict[Side, tuple[int, dict[str, int], int]]:
    """Column of each foot's time, of its zones by name, and of its total; FormatError without a foot."""
    out: dict[Side, tuple[int, dict[str, int], int]] = {}
    for side in SIDES:
        zones: dict[str, int] = {}
        clock = -1
        total = -1
        for i, unit in enumerate(units):
            match = _SENSOR.fullmatch(sensors[i].strip()) if i < len(sensors) else None
            if match is None or unit.strip() != "Force[N]" or match["side"].lower() != side[0]:
                continue
            clock = max(k for k in range(i) if units[k].strip() == "Time[secs]") if clock < 0 else clock
            if match["zone"] is None:
                total = i
            else:
                zones[match["zone"]] = i
        if zones and total >= 0:
            out[side] = (clock, zones, total)
    if not out:
        raise FormatError("no insole has zones and a total in N; allowed: columns such as PGV1-L::heel and PGV1-L")
    return out


def _check_total(side: Side, zones: list[str], values: NDArray[np.float64], warnings: list[str]) -> None:
    apart = np.abs(values[:, :-1].sum(axis=1) - values[:, -1])
    share = float(np.nanmax(apart, initial=0.0)) / max(float(np.nanmax(values[:, -1], initial=0.0)), 1e-9)
    if share > _APART:
        warnings.append(
            f"the {side} foot's total differs from the sum of {', '.join(zones)} by up to {100.0 * share:.2g} % of its "
            "largest value: the total is used"
        )


FORMAT = Format(
    name="loadsol",
    title="loadsol export with zones",
    suffixes=(".txt", ".csv"),
    recognises=_recognises,
    read=_read,
    order=18,
)
