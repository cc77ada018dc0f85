"""Moticon OpenGo text exports (.txt): tab-separated channels of two insoles of 16 cells.

"#" lines are the header; the last names channels with units. Empty values are radio dropouts. Total force and CoP are
the device's, as its cells cover a part of the sole.
"""

import math
import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.formats.cells_of_foot import scale_to_force, unit_of_values
from plantar.formats.format import Format, ReadOptions
from plantar.formats.nominal_insole import MOTICON_LENGTH, MOTICON_WIDTH, moticon_insole
from plantar.formats.stated_rate import in_seconds
from plantar.formats.text import head_text, number, open_text, table_of_lines
from plantar.formats.units import Unit, find_unit
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, layout_for, sampling

_CHANNEL = re.compile(r"(left|right)\s+(.*?)\s*(?:\[(.*)\])?\s*$", re.IGNORECASE)
# Channels of the inertial sensor, and what their units are in m/s^2 and rad/s.
_MOTION = {
    "acceleration": {"g": GRAVITY, "m/s2": 1.0, "m/s²": 1.0, "m/s^2": 1.0},
    "angular": {"dps": math.pi / 180.0, "deg/s": math.pi / 180.0, "°/s": math.pi / 180.0, "rad/s": 1.0},
}
_USUAL_UNIT = "N/cm2"
_LARGEST_HEADER = 1000
_MOST_CHANNELS = 10_000
_LONGEST_NAME = 200


def _recognises(head: bytes) -> bool:
    channels = r"^\W*#?\s*time[^\n]*(left|right) pressure 1"
    return re.search(channels, head_text(head), re.MULTILINE | re.IGNORECASE) is not None


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    warnings: list[str] = []
    with open_text(path) as stream:
        lines = iter(stream)
        header, channels, delimiter = _take_header(lines)
        wanted = _wanted(channels)
        rows = (line for line in lines if line.strip() and not line.startswith("#"))
        table = table_of_lines(path, rows, delimiter, len(channels), warnings, wanted)
    names = [channels[i] for i in wanted]
    time, rate, notes = sampling(in_seconds(table[:, 0], None, None, warnings, 0.5), None, options.rate_hz)
    size = _size(header, warnings)
    feet: dict[Side, FootRecording] = {}
    units: set[Unit] = set()
    for side in SIDES:
        columns = _columns(names, side)
        cells = sorted(
            (int(key.split()[-1]), i, unit) for key, (i, unit) in columns.items() if re.fullmatch(r"pressure \d+", key)
        )
        if not cells or np.isnan(table[:, [i for _, i, _ in cells]]).all():
            continue
        unit = _unit(options, [stated for _, _, stated in cells], warnings)
        units.add(unit)
        pressure = table[:, [i for _, i, _ in cells]]
        total = _total(columns, table, side, warnings)
        layout = _layout(side, size, pressure, unit, total, options, warnings)
        cop = _device_cop(columns, table, size, side) if options.layout is None else None
        if unit.kind == "raw":
            total = None
            cop = None
        motion = _motion(columns, table, side, warnings)
        feet[side] = FootRecording(side, pressure, layout, total=total, cop=cop, motion=motion)
        scale_to_force(pressure, unit, layout.areas)
    if not feet:
        raise FormatError("no channel 'left pressure 1' or 'right pressure 1' holds values")
    if len(units) > 1:
        warnings.append(f"the feet are in different units ({', '.join(sorted(u.name for u in units))})")
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={**header, "unit": next(iter(units)).name},
        warnings=(*warnings, *notes),
        raw=any(u.kind == "raw" for u in units),
    )


def _wanted(channels: list[str]) -> list[int]:
    found = [i for i, n in enumerate(channels) if i > 0 and _CHANNEL.match(n)]
    return [0, *(i for i in found if not re.search(r"label|events|steps", channels[i], re.IGNORECASE))]


def _take_header(lines: Iterator[str]) -> tuple[dict[str, str], list[str], str]:
    header: dict[str, str] = {}
    for line in islice(lines, _LARGEST_HEADER):
        text = line.lstrip("\ufeff").rstrip("\n")
        content = text.lstrip("# ")
        if re.match(r"\"?time\b.*(left|right) ", content, re.IGNORECASE):
            delimiter = next((d for d in "\t;," if d in content), "\t")
            names = [c.strip().strip('"')[:_LONGEST_NAME] for c in content.split(delimiter)]
            if len(names) > _MOST_CHANNELS:
                raise FormatError(f"{len(names)} channels cannot be read; allowed: up to {_MOST_CHANNELS}")
            return header, names, delimiter
        if text.startswith("#") and ":" in content:
            key, value = content.split(":", 1)
            header[key.strip()[:_LONGEST_NAME].lower()] = value.strip()[:_LONGEST_NAME]
    raise FormatError("not a Moticon export: no line names the channels ('# time', 'left pressure 1', ...)")


def _columns(names: list[str], side: Side) -> dict[str, tuple[int, str]]:
    out: dict[str, tuple[int, str]] = {}
    for i, name in enumerate(names):
        match = _CHANNEL.match(name)
        if match and match[1].lower() == side:
            channel = match[2].lower()
            if channel in out:
                raise FormatError(f"the channel '{side} {channel}' is there twice; allowed: once for each foot")
            out[channel] = i, match[3] or ""
    return out


def _unit(options: ReadOptions, stated: list[str], warnings: list[str]) -> Unit:
    text = options.unit or max(set(stated), key=stated.count)
    if len(set(stated)) > 1:
        warnings.append(f"the cells' units differ ({', '.join(sorted(set(stated)))}): {text} is used")
    if not text:
        warnings.append(f"the file states no unit of pressure: {_USUAL_UNIT} is assumed (--unit overrides)")
        text = _USUAL_UNIT
    return unit_of_values(text, options, warnings, pressures=True)


def _size(header: dict[str, str], warnings: list[str]) -> int | None:
    value = number(header.get("size", ""))
    if value is not None and int(value) in MOTICON_LENGTH:
        warnings.append(
            f"the file holds no cell geometry: a nominal insole of size {int(value)}, "
            f"{MOTICON_LENGTH[int(value)] * 1e3:.0f} mm long, is used; CoP and lengths rest on it (--layout overrides)"
        )
        return int(value)
    warnings.append(
        f"the file names no known insole size: a nominal one of {MOTICON_LENGTH[7] * 1e3:.0f} mm (size 7) is assumed; "
        "CoP, lengths and areas rest on it (--layout overrides)"
    )
    return None


def _total(
    columns: dict[str, tuple[int, str]], table: NDArray[np.float64], side: Side, warnings: list[str]
) -> NDArray[np.float64] | None:
    if "total force" not in columns or not np.nan_to_num(table[:, columns["total force"][0]]).any():
        warnings.append(f"the file holds no total force of the {side} foot: it is the sum over the cells")
        return None
    index, stated = columns["total force"]
    unit = find_unit(stated) if stated else Unit("force", 1.0, "N")
    if not stated:
        warnings.append(f"the {side} foot's total force states no unit: N is assumed")
    if unit is None or unit.kind != "force":
        raise FormatError(f"unknown unit of force {stated!r}; allowed: N, kN, kg and their like")
    return table[:, index] * unit.factor


def _layout(
    side: Side,
    size: int | None,
    pressure: NDArray[np.float64],
    unit: Unit,
    total: NDArray[np.float64] | None,
    options: ReadOptions,
    warnings: list[str],
) -> SoleLayout:
    given = layout_for(side, options.layout)
    if given is not None:
        return given
    if pressure.shape[1] != 16:
        raise FormatError(f"the {side} foot has {pressure.shape[1]} cells, not 16; give a layout with --layout")
    layout = moticon_insole(size, side)
    if total is None or unit.kind == "raw":
        return layout
    sums = pressure @ (unit.factor * layout.areas)
    known = np.isfinite(sums) & (sums > 0.0) & np.isfinite(total) & (total > 50.0)
    if known.sum() < 10:
        return layout
    ratio = float(np.median(total[known] / sums[known]))
    if not 0.4 <= ratio <= 2.5:
        warnings.append(
            f"the {side} foot's total force is {ratio:.3g} times pressure times area of its cells: check the unit"
        )
        return layout
    return moticon_insole(size, side, layout.areas * ratio)  # this insole's own areas


def _device_cop(
    columns: dict[str, tuple[int, str]], table: NDArray[np.float64], size: int | None, side: Side
) -> NDArray[np.float64] | None:
    if "center of pressure x" not in columns or "center of pressure y" not in columns:
        return None
    along, across = (table[:, columns[f"center of pressure {axis}"][0]] for axis in "xy")
    length = MOTICON_LENGTH[size or 7]
    outward = 1.0 if side == "right" else -1.0
    out = np.column_stack([(along + 0.5) * length, outward * across * MOTICON_WIDTH * length])
    out[(np.abs(along) > 0.75) | (np.abs(across) > 0.75) | ((along == 0.0) & (across == 0.0))] = np.nan
    out[np.isnan(out).any(axis=1)] = np.nan
    return out if np.isfinite(out).any() else None  # an empty column, or shares of something else


def _motion(
    columns: dict[str, tuple[int, str]], table: NDArray[np.float64], side: Side, warnings: list[str]
) -> NDArray[np.float64] | None:
    """Acceleration in m/s^2 and angular rate in rad/s (n, 6) of the insole's inertial sensor; None without it."""
    names = [f"{kind} {axis}" for kind in _MOTION for axis in "xyz"]
    if not all(name in columns for name in names):
        return None
    factors = [_MOTION[name.split()[0]].get(columns[name][1].strip().lower()) for name in names]
    known = [factor for factor in factors if factor is not None]
    if len(known) < len(names):
        stated = ", ".join(dict.fromkeys(columns[name][1] or "none" for name in names))
        warnings.append(
            f"the {side} foot's inertial sensor has the units {stated}: strides are not taken from it; allowed: g or "
            "m/s2, and dps or rad/s"
        )
        return None
    motion = table[:, [columns[name][0] for name in names]] * np.array(known)
    return motion if np.isfinite(motion).all(axis=1).any() else None


FORMAT = Format(
    name="moticon", title="Moticon OpenGo export", suffixes=(".txt",), recognises=_recognises, read=_read, order=15
)
