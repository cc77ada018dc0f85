"""Changes of a table that change, or may change, what it means: numbers, times, rows, columns, and ways of writing."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .taken_away import Made

Change = Callable[[Made, np.random.Generator], bytes]


def _loads(table: Made) -> list[int]:
    return [i for i, (n, u) in enumerate(zip(table.names, table.units, strict=True)) if i and n != "side" and u != "m"]


def _forces(table: Made) -> list[int]:
    return [i for i in _loads(table) if "_p" not in table.names[i]]


def _with_cells(table: Made, columns: list[int], change: Callable[[float], float], rows: slice = slice(None)) -> bytes:
    picked = set(range(len(table.rows))[rows])
    out = [
        [f"{change(float(c)):.5f}" if k in picked and i in columns else c for i, c in enumerate(row)]
        for k, row in enumerate(table.rows)
    ]
    return replace(table, rows=out).text().encode()


def _scaled(factor: float, one: bool = False) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        columns = _forces(table)
        return _with_cells(table, [int(random.choice(columns))] if one else columns, lambda v: factor * v)

    return change


def _shifted(share: float) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        top = max(float(row[i]) for row in table.rows for i in _forces(table))
        return _with_cells(table, [int(random.choice(_forces(table)))], lambda v: v + share * top)

    return change


def _clipped(share: float) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        tops = {i: max(float(row[i]) for row in table.rows) for i in _forces(table)}
        end = share * float(np.median(list(tops.values())))  # of the range of all sensors
        out = [[f"{min(float(c), end):.5f}" if i in tops else c for i, c in enumerate(row)] for row in table.rows]
        return replace(table, rows=out).text().encode()

    return change


def _dead(table: Made, random: np.random.Generator) -> bytes:
    return _with_cells(table, [int(random.choice(_forces(table)))], lambda v: 0.0)


def _marked(mark: str, share: float) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        forces = _forces(table)
        out = [
            [mark if i in forces and random.random() < share else c for i, c in enumerate(row)] for row in table.rows
        ]
        return replace(table, rows=out).text().encode()

    return change


def _time(change_of: Callable[[np.ndarray, np.random.Generator], np.ndarray]) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        time = change_of(np.array([float(row[0]) for row in table.rows]), random)
        rows = [[f"{t:.5f}", *row[1:]] for t, row in zip(time, table.rows, strict=True)]
        return replace(table, rows=rows).text().encode()

    return change


def _gap(time: np.ndarray, random: np.random.Generator) -> np.ndarray:
    step = float(np.median(np.diff(np.unique(time))))
    return time + np.where(np.arange(len(time)) > len(time) // 2, 170.0 * step, 0.0)


def _rows(change_of: Callable[[list, np.random.Generator], list]) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        return replace(table, rows=change_of(table.rows, random)).text().encode()

    return change


def _text(change_of: Callable[[str, Made], str], encoding: str = "utf-8") -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        return change_of(table.text(), table).encode(encoding)

    return change


def _comma(text: str, table: Made) -> str:
    lines = text.replace(table.delimiter, ";").splitlines()
    first = len(table.above) + 1
    return "\n".join([*lines[:first], *(line.replace(".", ",") for line in lines[first:])]) + "\n"


def _again(text: str, table: Made) -> str:
    lines = text.splitlines()
    head = lines[len(table.above)]
    middle = len(lines) // 2
    return "\n".join([*lines[:middle], head, *lines[middle:]]) + "\n"


def _permuted(table: Made, random: np.random.Generator) -> bytes:
    order = [0, *(1 + random.permutation(len(table.names) - 1)).tolist()]
    rows = [[row[i] for i in order] for row in table.rows]
    names = [table.names[i] for i in order]
    units = [table.units[i] for i in order]
    return replace(table, names=names, units=units, rows=rows).text().encode()


def _with_column(name: str, value: Callable[[list[str], int], str]) -> Change:
    def change(table: Made, random: np.random.Generator) -> bytes:
        rows = [[*row, value(row, i)] for i, row in enumerate(table.rows)]
        return replace(table, names=[*table.names, name], units=[*table.units, ""], rows=rows).text().encode()

    return change


CHANGES: dict[str, Change] = {
    "a thousand times": _scaled(1000.0),
    "a thousandth": _scaled(0.001),
    "turned": _scaled(-1.0),
    "one turned": _scaled(-1.0, one=True),
    "one tenfold": _scaled(10.0, one=True),
    "one a tenth": _scaled(0.1, one=True),
    "an offset of a tenth": _shifted(0.1),
    "an offset of a third": _shifted(0.33),
    "an offset below": _shifted(-0.2),
    "clipped at 70 %": _clipped(0.7),
    "clipped at 90 %": _clipped(0.9),
    "a dead column": _dead,
    "marks of -999": _marked("-999", 0.02),
    "marks of 9999": _marked("9999", 0.02),
    "nan": _marked("nan", 0.05),
    "empty cells": _marked("", 0.05),
    "inf": _marked("inf", 0.005),
    "1e308": _marked("1e308", 0.005),
    "words": _marked("bad", 0.05),
    "times a thousand times": _time(lambda t, r: 1000.0 * t),
    "times a thousandth": _time(lambda t, r: 0.001 * t),
    "times from a clock": _time(lambda t, r: t + 1.7e9),
    "times that jitter": _time(lambda t, r: t + 0.3 * np.median(np.diff(np.unique(t))) * r.uniform(-1, 1, len(t))),
    "a gap in the times": _time(_gap),
    "times backwards": _time(lambda t, r: t[::-1].copy()),
    "rows backwards": _rows(lambda rows, r: rows[::-1]),
    "rows shuffled": _rows(lambda rows, r: [rows[i] for i in r.permutation(len(rows))]),
    "rows twice": _rows(lambda rows, r: [row for row in rows for _ in range(2)]),
    "a block twice": _rows(lambda rows, r: [*rows[: len(rows) // 2], *rows[len(rows) // 4 :]]),
    "two recordings": _rows(lambda rows, r: [*rows, *rows]),
    "columns in another order": _permuted,
    "a column of words": _with_column("remark", lambda row, i: "ok"),
    "a column of a counter": _with_column("counter", lambda row, i: str(i)),
    "a column of temperature": _with_column("temp [degC]", lambda row, i: f"{25 + 0.001 * i:.3f}"),
    "decimal commas": _text(_comma),
    "names again": _text(_again),
    "CRLF": _text(lambda text, t: text.replace("\n", "\r\n")),
    "a byte order mark": _text(lambda text, t: "\ufeff" + text),
    "UTF-16": _text(lambda text, t: text, "utf-16"),
    "comments": _text(lambda text, t: "# made\n# by hand\n" + text),
    "a delimiter at the end": _text(lambda text, t: text.replace("\n", t.delimiter + "\n")),
    "blank lines": _text(lambda text, t: text.replace("\n", "\n\n")),
}
"""Kinds of change; with the six kinds of table more than two hundred."""
