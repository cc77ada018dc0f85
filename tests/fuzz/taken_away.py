"""Tables named by the dictionary of names, with one thing taken away: a name, unit, clock, side, plate or rows."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from plantar.formats.field_names import _WORDS_OF_KIND

RATE = 100.0
PERIOD = 1.12
STANCE = 0.64
SIDES = ("left", "right")
KINDS = ("feet", "plates", "cells", "places", "rows of a foot", "mot")
_PLACES = ("heel", "midfoot", "met1", "met5", "hallux")
_UNITS = {"N": 1.0, "kN": 1e-3, "lbf": 1.0 / 4.4482216152605, "kgf": 1.0 / 9.80665}
_TIMES = {"time [s]": 1.0, "Time (ms)": 1e3, "timestamp [ms]": 1e3, "Zeit [s]": 1.0, "elapsed time (s)": 1.0}


_Series = dict[str, NDArray[np.float64]]


@dataclass(frozen=True)
class Made:
    """A table before it is written, and what is true of it.

    Attributes:
        kind: One of `KINDS`.
        names: Of the columns, without units (k,).
        units: Of the columns, empty without one (k,).
        rows: Numbers (n, k), or texts where a column names feet.
        sides: Foot of each column, empty for none (k,).
        plates: Plate of each column, 0 for none (k,).
        above: Lines above the names.
        delimiter: Between cells.
        peak: Largest force of each foot in N.
        begins: Heel strikes of each foot in s.
    """

    kind: str
    names: list[str]
    units: list[str]
    rows: list[list[str]]
    sides: list[str]
    plates: list[int]
    above: list[str]
    delimiter: str
    peak: dict[str, float]
    begins: dict[str, NDArray[np.float64]]
    states: dict[str, str] = field(default_factory=dict)
    taken: str = "nothing"

    def text(self) -> str:
        """The file."""
        heads = [f"{n} [{u}]" if u else n for n, u in zip(self.names, self.units, strict=True)]
        named = [self.delimiter.join(heads)] if any(heads) else []
        return "\n".join([*self.above, *named, *(self.delimiter.join(row) for row in self.rows)]) + "\n"

    def without(self, columns: set[int]) -> "Made":
        """The table without some columns."""
        keep = [i for i in range(len(self.names)) if i not in columns]
        return replace(
            self,
            names=[self.names[i] for i in keep],
            units=[self.units[i] for i in keep],
            sides=[self.sides[i] for i in keep],
            plates=[self.plates[i] for i in keep],
            rows=[[row[i] for i in keep] for row in self.rows],
        )


def _walk(random: np.random.Generator) -> tuple[NDArray[np.float64], _Series, _Series, _Series]:
    time = np.arange(0.0, 9.0, 1.0 / RATE)
    top = random.uniform(600.0, 1000.0)
    forces = {}
    gone = {}
    begins = {}
    for k, side in enumerate(SIDES):
        phase = 0.4 + 0.5 * k * PERIOD
        share = ((time - phase) % PERIOD) / PERIOD / STANCE
        inside = np.clip(share, 0.0, 1.0)
        humps = np.sin(np.pi * inside) + 0.22 * np.sin(3.0 * np.pi * inside)
        on = (share < 1.0) & (time > phase - 0.2)
        forces[side] = np.where(on, top * humps / humps.max(), 0.0)
        gone[side] = inside
        begins[side] = np.arange(phase, 9.0, PERIOD)
    return time, forces, gone, begins


def made(seed: int) -> Made:
    """A table of a seed, whole."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    time, forces, gone, begins = _walk(random)
    unit = str(random.choice(list(_UNITS)))
    factor = _UNITS[unit]
    clock = str(random.choice(list(_TIMES)))
    words = {side: str(random.choice([w for w in _WORDS_OF_KIND[side].split() if len(w) > 1])) for side in SIDES}
    force = str(random.choice([w for w in _WORDS_OF_KIND["force"].split() if len(w) > 3 and w != "last"]))
    sign = str(random.choice([" ", "_", "."]))
    name, _, stated = clock.replace("(", "[").partition(" [")
    names = [name]
    units = [stated.strip("])")]
    columns = [time * _TIMES[clock]]
    sides = [""]
    plates = [0]

    def add(label: str, of_unit: str, values: NDArray[np.float64], side: str = "", plate: int = 0) -> None:
        names.append(label)
        units.append(of_unit)
        columns.append(values)
        sides.append(side)
        plates.append(plate)

    for k, side in enumerate(SIDES):
        load = forces[side]
        ahead = 0.2 * load * (2.0 * gone[side] - 1.0)
        leftward = (-0.05, 0.05)[k] * load
        if kind == "feet":
            add(f"{words[side]}{sign}{force}", unit, factor * load, side)
        elif kind in ("cells", "places"):
            shares = np.exp(-(((gone[side][:, None] - np.linspace(0.1, 0.9, 5)) / 0.4) ** 2))
            for i, part in enumerate((load[:, None] * shares / shares.sum(axis=1, keepdims=True)).T):
                label = str(i + 1) if kind == "cells" else _PLACES[i]
                add(f"{words[side]}{sign}{label}", unit, factor * part, side)
        elif kind == "plates":
            for axis, values in zip("xyz", (ahead, leftward, load), strict=True):
                add(f"FP{k + 1}{sign}F{axis}", unit, factor * values, side, k + 1)
            place = np.where(load > 0.0, 0.2 * gone[side] - 1.2 * gone[side] * STANCE * PERIOD, 0.0)
            add(f"FP{k + 1}{sign}COPx", "m", place, side, k + 1)
            add(f"FP{k + 1}{sign}COPy", "m", np.where(load > 0.0, (0.1, -0.1)[k], 0.0), side, k + 1)
        elif kind == "mot":
            before = ("l_", "r_")[k]
            turned = (ahead, load, -leftward)
            for axis, values in zip("xyz", turned, strict=True):
                add(f"{before}ground_force_v{axis}", "", values, side, k + 1)
            place = np.where(load > 0.0, 0.2 * gone[side] - 1.2 * gone[side] * STANCE * PERIOD, 0.0)
            for axis, values in zip("xyz", (place, 0.0 * load, np.where(load > 0.0, (-0.1, 0.1)[k], 0.0)), strict=True):
                add(f"{before}ground_force_p{axis}", "", values, side, k + 1)
    above = []
    delimiter = str(random.choice([",", "\t", ";"]))
    rows = [[f"{v:.5f}" for v in row] for row in np.column_stack(columns)]
    if kind == "mot":
        delimiter = "\t"
        above = [f"walk{seed}.mot", "version=1", f"datacolumns {len(names)}", f"datarows {len(rows)}", "endheader"]
        names[0] = "time"
        units = [""] * len(units)
        rows = [[f"{v:.5f}" for v in row] for row in np.column_stack([time, *columns[1:]])]
    if kind == "rows of a foot":
        names = [name, "side", force]
        units = [units[0], "", unit]
        sides = ["", "", ""]
        plates = [0, 0, 0]
        of = [(t, side, f) for i, t in enumerate(columns[0]) for side in SIDES for f in [factor * forces[side][i]]]
        rows = [[f"{t:.5f}", words[side], f"{f:.5f}"] for t, side, f in of]
    peak = {side: float(forces[side].max()) for side in SIDES}
    states = {"unit": unit if kind != "mot" else "N", "rate": f"{RATE:g}"}
    return Made(kind, names, units, rows, sides, plates, above, delimiter, peak, begins, states)


Change = Callable[[Made, np.random.Generator], Made]


def _loads(table: Made) -> list[int]:
    return [i for i in range(1, len(table.names)) if table.names[i] != "side"]


def _renamed(table: Made, columns: list[int], name: Callable[[str], str]) -> Made:
    return replace(table, names=[name(n) if i in columns else n for i, n in enumerate(table.names)])


def _a_name(table: Made, random: np.random.Generator) -> Made:
    return _renamed(table, [int(random.choice(_loads(table)))], lambda n: "")


def _all_names(table: Made, random: np.random.Generator) -> Made:
    return replace(table, names=[""] * len(table.names), units=[""] * len(table.names))


def _a_unit(table: Made, random: np.random.Generator) -> Made:
    at = int(random.choice(_loads(table)))
    return replace(table, units=["" if i == at else u for i, u in enumerate(table.units)])


def _all_units(table: Made, random: np.random.Generator) -> Made:
    return replace(table, units=["" if i in _loads(table) else u for i, u in enumerate(table.units)])


def _unit_of_the_clock(table: Made, random: np.random.Generator) -> Made:
    return replace(table, units=["", *table.units[1:]])


def _the_clock(table: Made, random: np.random.Generator) -> Made:
    return table.without({0})


def _name_of_the_clock(table: Made, random: np.random.Generator) -> Made:
    return replace(_renamed(table, [0], lambda n: ""), units=["", *table.units[1:]])


def _a_side(table: Made, random: np.random.Generator) -> Made:
    side = str(random.choice(SIDES))
    if table.kind == "rows of a foot":
        word = table.rows[0 if side == "left" else 1][1]
        return replace(table, rows=[row for row in table.rows if row[1] != word], peak={}, taken=side)
    return table.without({i for i, s in enumerate(table.sides) if s == side})


def _words_of_sides(table: Made, random: np.random.Generator) -> Made:
    if table.kind == "rows of a foot":
        return table.without({1})
    words = {w for side in SIDES for w in _WORDS_OF_KIND[side].split()}

    def plain(name: str) -> str:
        parts = [p for p in name.replace("_", " ").replace(".", " ").split() if p.lower() not in words]
        return " ".join(parts)

    return _renamed(table, _loads(table), plain)


def _a_plate(table: Made, random: np.random.Generator) -> Made:
    return _a_side(table, random)


def _a_channel(table: Made, random: np.random.Generator) -> Made:
    return table.without({int(random.choice(_loads(table)))})


def _a_row(table: Made, random: np.random.Generator) -> Made:
    at = int(random.integers(20, len(table.rows) - 20))
    return replace(table, rows=[row for i, row in enumerate(table.rows) if i != at])


def _a_fifth_of_the_rows(table: Made, random: np.random.Generator) -> Made:
    keep = random.random(len(table.rows)) > 0.2
    return replace(table, rows=[row for row, kept in zip(table.rows, keep, strict=True) if kept])


def _the_first_rows(table: Made, random: np.random.Generator) -> Made:
    return replace(table, rows=table.rows[2 * int(random.integers(20, 150)) :])


def _a_second(table: Made, random: np.random.Generator) -> Made:
    per = len(table.rows) // 9
    at = per * int(random.integers(3, 6))
    return replace(table, rows=[*table.rows[:at], *table.rows[at + per :]])


def _half_a_row(table: Made, random: np.random.Generator) -> Made:
    last = table.rows[-1]
    return replace(table, rows=[*table.rows[:-1], last[: max(1, len(last) // 2)]])


CHANGES: dict[str, Change] = {
    "a name": _a_name,
    "all names": _all_names,
    "a unit": _a_unit,
    "all units": _all_units,
    "the clock's unit": _unit_of_the_clock,
    "the clock": _the_clock,
    "the clock's name": _name_of_the_clock,
    "a side": _a_side,
    "the words of sides": _words_of_sides,
    "a plate": _a_plate,
    "a channel": _a_channel,
    "a row": _a_row,
    "a fifth of the rows": _a_fifth_of_the_rows,
    "the first rows": _the_first_rows,
    "a second": _a_second,
    "half of the last row": _half_a_row,
}
"""What is taken away."""


def taken(seed: int) -> Made:
    """The table of a seed with one thing taken away."""
    names = list(CHANGES)
    name = names[(seed // len(KINDS)) % len(names)]
    return replace(CHANGES[name](made(seed), np.random.default_rng(seed + 10_000)), taken=name)
