"""Tables of plate, belt or foot forces: columns grouped by plate or foot, axis and quantity."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.formats.field_names import BODY_WEIGHTS, OF_PLATES, Heading
from plantar.formats.force_plates import feet_of_plates
from plantar.formats.format import ReadOptions
from plantar.formats.plate_sides import Plate
from plantar.formats.units import FORCES, LENGTHS, MOMENTS, plain
from plantar.recordings.pressure_recording import FootRecording, Kind

_Key = tuple[Side | None, int | None]
# The two horizontal axes, right-handed with each vertical one.
_UPRIGHT = {"z": ("x", "y"), "y": ("z", "x"), "x": ("y", "z")}
# How often a mark for missing values is there at least, different values of its column, and its smallest magnitude.
_FEWEST = 3
_LEVELS = 10
_LEAST = 9.0
_WEIGHTS = (0.7, 4.0)  # Largest vertical forces without a unit that are body weights and no N
# Weight in N that forces in body weights are read with, so that levels in N hold; they are divided by it again.
_NOMINAL = 700.0
_LEAST_NEWTONS = 150.0  # Forces without a unit that reach less are in another one
_TOTALS = {"total", "sum", "gesamt", "summe", "totale", "tot"}  # of both feet, beside each


def is_force_table(headings: Sequence[Heading]) -> bool:
    """Whether headings, without times, are forces of plates or whole feet: of an axis, ground, plate, or one a foot."""
    forces = [h for h in headings if h.quantity == "force"]
    whole = {h.side for h in forces if h.number is None}  # whose one pressure is the mean or the largest of its cells
    cells = [
        h
        for h in headings
        if (h.quantity == "pressure" and (h.number is not None or h.side not in whole))
        or h.quantity == "cell"
        or (h.quantity == "number" and h.number is not None)
    ]
    if any(h.axis or h.plate for h in forces) and not (len(cells) > 2 * len(forces)):
        return True
    own = [(h.side, h.number) for h in forces]
    if any(h.side and h.quantity == "number" for h in headings) and not any(side for side, _ in own):
        return False  # the sum of two feet, beside them
    one_a_foot = bool(own) and all(n is None for _, n in own) and len(set(own)) == len(own) and len(own) <= 2
    return one_a_foot and not cells


def feet_of_forces(
    table: NDArray[np.float64],
    columns: Mapping[int, Heading],
    rate: float,
    options: ReadOptions,
    stated: str | None,
    warnings: list[str],
) -> tuple[dict[Side, FootRecording], bool, Kind, bool]:
    """Returns feet; whether every step is seen; "plate" or "insole"; and whether forces are percent of body weight.

    `table`: numbers (n, k); `columns`: headings by column number, without times; `stated`: unit in comments;
    FormatError if unknown, or no force is vertical.
    """
    _take_out_marks(table, columns, warnings)
    loaded = _by_plate(columns)
    up = _vertical(table, loaded, warnings)
    verticals = {
        key: a
        for key, own in loaded.items()
        if (a := next((a for a in ("vertical", up, "") if a in own["force"]), None)) is not None
    }
    forces = [columns[i] for own in loaded.values() for i in own["force"].values()]
    units = dict.fromkeys(h.unit for h in forces if h.unit)
    if len(set(map(plain, units))) > 1 and not options.unit:
        raise FormatError(f"the forces are in different units: {', '.join(units)}; allowed: one unit, or --unit")
    if not verticals:
        raise FormatError("no column is a vertical force; allowed: Fz, a vertical GRF, or forces of all three axes")
    upward = [loaded[key]["force"][axis] for key, axis in verticals.items()]
    text = options.unit or next((columns[i].unit for i in upward if columns[i].unit), stated) or ""
    unit, relative = _unit(text, table[:, upward], options, warnings)
    made = [_plate(table, columns, key, loaded[key], a, unit, warnings) for key, a in verticals.items()]
    scale = 100.0 / _NOMINAL if relative else 1.0
    sides = [p.side for p in made if p.side]
    named = len(sides) == len(made)
    if named and len(made) <= 2 and not any(h.plate for h in forces):
        totals = {s: _upward(p.force[:, 2] * scale, p.name, warnings) for s, p in zip(sides, made, strict=True)}
        feet = {s: FootRecording(s, totals[s][:, None], None, total=totals[s]) for s in SIDES if s in totals}
        warnings.append("one force a foot: no cells, so no pressures, areas and centres of pressure")
        return feet, True, "insole", relative
    if named and len(set(sides)) < len(made):
        made = [replace(p, name=f"{p.name} {number}") for p, (_, number) in zip(made, verticals, strict=True)]
    feet, every = feet_of_plates(made, rate, options, warnings)
    if relative:
        feet = {s: _scaled(f, scale) for s, f in feet.items()}
    return feet, every or (named and len(made) == 2), "plate", relative


def _take_out_marks(table: NDArray[np.float64], columns: Mapping[int, Heading], warnings: list[str]) -> None:
    """NaN for a repeated value that is farther from all others than half of what these range over, such as -999."""
    count = 0
    marks: list[str] = []
    for i, h in columns.items():
        value, times = np.unique(table[np.isfinite(table[:, i]), i], return_counts=True)
        if h.quantity not in OF_PLATES or len(value) < _LEVELS:
            continue
        least = 0.5 * (value[-2] - value[1])
        for mark, near, often in ((value[0], value[1], times[0]), (value[-1], value[-2], times[-1])):
            if abs(mark) >= _LEAST and mark == round(mark) and often >= _FEWEST and abs(mark - near) > least:
                table[table[:, i] == mark, i] = np.nan
                count = count + int(often)
                marks.append(f"{mark:g}")
    if marks:
        shown = ", ".join(dict.fromkeys(marks))
        warnings.append(f"{count} value(s) are {shown}, far from all others: taken as marks for what was not measured")


def _by_plate(columns: Mapping[int, Heading]) -> dict[_Key, dict[str, dict[str, int]]]:
    groups: dict[_Key, dict[str, dict[str, int]]] = {}
    both = {h.side for h in columns.values() if h.quantity == "force"} >= set(SIDES)
    for i, h in columns.items():
        if h.quantity in OF_PLATES and (h.side or not both or _TOTALS.isdisjoint(h.words.split())):
            groups.setdefault((h.side, h.number), {}).setdefault(h.quantity, {}).setdefault(h.axis, i)
    return {key: own for key, own in groups.items() if "force" in own}


def _upward(force: NDArray[np.float64], name: str, warnings: list[str]) -> NDArray[np.float64]:
    low, high = (float(v) for v in np.nanpercentile(force, (5.0, 95.0))) if np.isfinite(force).any() else (0.0, 0.0)
    if low + high >= 0.0:
        return force
    warnings.append(f"the force of {name} points down: turned to that on the foot")
    return -force


def _scaled(foot: FootRecording, scale: float) -> FootRecording:
    total = None if foot.total is None else foot.total * scale
    wrench = None if foot.wrench is None else foot.wrench * scale
    return replace(foot, force=foot.force * scale, total=total, wrench=wrench)


def _vertical(table: NDArray[np.float64], groups: Mapping[_Key, dict[str, dict[str, int]]], warnings: list[str]) -> str:
    load = dict.fromkeys("zyx", 0.0)
    forces = [own["force"] for own in groups.values()]
    for axis, i in [(a, own[a]) for own in forces for a in load if a in own]:
        known = np.abs(table[np.isfinite(table[:, i]), i])
        load[axis] += float(np.percentile(known, 95.0) + known.mean()) if len(known) else 0.0
    up = max(load, key=lambda a: load[a])
    if up != "z" and not any("vertical" in own for own in forces):
        warnings.append(f"the largest force acts along {up}: taken as the vertical axis")
    return up


def _unit(text: str, vertical: NDArray[np.float64], options: ReadOptions, warnings: list[str]) -> tuple[float, bool]:
    """N in one unit of a text, or of the size of vertical forces, and whether relative to an unknown body weight."""
    largest = float(np.nanpercentile(np.abs(vertical), 99.5))
    if not text and _WEIGHTS[0] <= largest <= _WEIGHTS[1]:
        text = "BW"
        warnings.append(
            f"the forces state no unit and reach {largest:.3g}: taken as body weights, where kN or volts would reach "
            "as much (--unit overrides)"
        )
    if not text and largest < _LEAST_NEWTONS:
        raise FormatError(
            f"the forces state no unit and reach {largest:.3g}, which no foot presses in N; allowed: --unit N, kN, "
            "kg, lbf or BW (volts of a plate need its calibration)"
        )
    if not text:
        warnings.append(f"the forces state no unit: N is assumed, in which they reach {largest:.4g} (--unit overrides)")
    name = plain(text or "N")
    if name in FORCES:
        return FORCES[name], False
    if name not in BODY_WEIGHTS:
        raise FormatError(f"unknown unit of force {text!r}; allowed: N, kN, kg, lbf, BW, %BW, N/kg")
    if options.mass_kg is None:
        warnings.append(f"forces are in {text}: given in percent of body weight; --mass makes N of them")
        return BODY_WEIGHTS[name] * _NOMINAL, True
    return BODY_WEIGHTS[name] * (options.mass_kg * GRAVITY), False


def _plate(
    table: NDArray[np.float64],
    columns: Mapping[int, Heading],
    key: _Key,
    own: Mapping[str, Mapping[str, int]],
    vertical: str,
    unit: float,
    warnings: list[str],
) -> Plate:
    side, number = key
    name = f"plate {number}" if number is not None else f"the {side} plate" if side else "the plate"
    up = vertical if vertical in _UPRIGHT else "z"
    forces = own["force"]
    unknown = np.full(len(table), np.nan)

    def of(quantity: Mapping[str, int], axis: str, other: str) -> NDArray[np.float64]:
        i = quantity.get(axis, quantity.get(other))
        return unknown if i is None else table[:, i]

    ahead, across = _UPRIGHT[up]
    force = unit * np.column_stack([of(forces, ahead, "ap"), of(forces, across, "ml"), table[:, forces[vertical]]])
    places = own.get("cop") or (own.get("place") if len(forces) > 1 else None) or {}
    cop = None
    if {ahead, across} <= set(places) or {"ap", "ml"} <= set(places):
        cop = np.column_stack([of(places, ahead, "ap"), of(places, across, "ml")])
        cop = cop * _length(columns[places.get(ahead, places.get("ap", 0))].unit, cop, force[:, 2], warnings)
    moments = own.get("moment", {})
    moment = None
    if cop is None and {"x", "y", "z"} <= set(moments) and {"x", "y", "z"} <= set(forces):
        turned = np.column_stack([table[:, moments[a]] for a in (ahead, across, up)])
        turn = MOMENTS.get(plain(columns[moments[up]].unit))
        if turn is None:
            large = float(np.nanpercentile(np.abs(turned), 99.0)) > 0.5 * float(np.nanpercentile(np.abs(force), 99.0))
            turn = 1e-3 if large else 1.0
            warnings.append(f"the moments state no unit: {'N mm' if large else 'N m'} is assumed")
        moment = turn * turned
    return Plate(name, force, moment, cop, side=side)


def _length(unit: str, cop: NDArray[np.float64], vertical: NDArray[np.float64], warnings: list[str]) -> float:
    # The unit of places where the file does not state it: a person's CoP ranges over more than 5 mm, and less than 5 m.
    known = LENGTHS.get(plain(unit))
    if known is not None:
        return known
    loaded = np.abs(vertical) > 0.2 * float(np.nanmax(np.abs(vertical), initial=0.0))
    part = cop[loaded & np.isfinite(cop).all(axis=1)]
    factor = 1e-3 if len(part) and float(np.ptp(part, axis=0).max()) > 5.0 else 1.0
    warnings.append(f"the centres of pressure state no unit: {'mm' if factor < 1.0 else 'm'} is assumed")
    return factor
