"""Tables drawn by a seed, with the walk in them: forces of feet, plates, cells of insoles, sensors by place."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

KINDS = ("forces of feet", "plates", "cells", "sensors by place")
PLACES = ("heel", "midfoot", "met1", "met3", "met5", "toe", "hallux")
_SIDES = (("left", "right"), ("Left", "Right"), ("L", "R"), ("LEFT", "RIGHT"), ("links", "rechts"), ("l", "r"))
_FORCES = ("Fz", "GRF", "vGRF", "Force Z", "Vertical Force", "force", "GRFz", "Fz", "Total Force", "Kraft")
_UNITS = (("N", 1.0), ("kN", 1e-3), ("kgf", 1.0 / 9.80665), ("lbf", 1.0 / 4.4482216152605), ("N", 1.0))
_RELATIVE = (("%BW", 100.0), ("BW", 1.0), ("N/kg", 9.80665))
_TIMES = (("Time (s)", 1.0), ("time", 1.0), ("Time [ms]", 1e3), ("timestamp_ms", 1e3), ("Zeit [s]", 1.0), ("t", 1.0))


@dataclass
class Table:
    """A table's text and what is true of it."""

    kind: str
    time: np.ndarray
    force: dict[str, np.ndarray]
    begins: dict[str, np.ndarray]
    stance: float
    period: float
    mass: float
    names: list[str] = field(default_factory=list)
    relative: bool = False
    raw: bool = False
    sides: tuple[str, ...] = ("left", "right")
    cells: int = 0
    note: str = ""
    twist: str = ""


TWISTS = (
    "units row",
    "groups",
    "no names",
    "rows of either foot",
    "blanks",
    "counter",
    "clock",
    "other sensors",
    "totals",
    "heading",
)


def made_table(seed: int, path: Path, hard: bool = False) -> Table:
    """Write the table of a seed and give what it holds; a hard one has a twist."""
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    rate = float(random.choice([50.0, 100.0, 200.0]))
    period, share = random.uniform(0.95, 1.35), random.uniform(0.58, 0.66)
    mass = random.uniform(45.0, 110.0)
    time = np.arange(0.0, 9.0, 1.0 / rate)
    force, begins = {}, {}
    for k, side in enumerate(("left", "right")):
        phase = 0.35 + 0.5 * k * period
        gone = ((time - phase) % period) / period / share
        inside = np.clip(gone, 0.0, 1.0)
        humps = np.sin(np.pi * inside) + 0.22 * np.sin(3.0 * np.pi * inside)
        force[side] = np.where(
            (gone < 1.0) & (time > phase - share * period * 0.2), 1.1 * mass * 9.80665 * humps / humps.max(), 0.0
        )
        begins[side] = np.arange(phase, 9.0 - share * period - 0.05, period)
    made = Table(kind, time, force, begins, share * period, period, mass)
    columns = {"forces of feet": _feet, "plates": _plates, "cells": _cells, "sensors by place": _places}[kind](
        made, random
    )
    twist = str(random.choice(TWISTS)) if hard else ""
    _write(path, made, columns, rate, random, twist)
    return made


def _join(random: np.random.Generator, words: Sequence[str]) -> str:
    return str(random.choice(["_", " ", ".", "-"])).join(w for w in words if w)


def _with_unit(random: np.random.Generator, name: str, unit: str) -> str:
    return name + str(random.choice([f" ({unit})", f" [{unit}]", f"({unit})", f"[{unit}]"]))


def _feet(made: Table, random: np.random.Generator) -> list[np.ndarray]:
    pair, force = _SIDES[int(random.integers(len(_SIDES)))], str(random.choice(_FORCES))
    relative = random.random() < 0.3
    unit, factor = (_RELATIVE if relative else _UNITS)[int(random.integers(3 if relative else 5))]
    factor /= made.mass * 9.80665 if relative else 1.0
    stated = bool(random.random() < 0.7 or (unit not in ("N", "BW")))
    made.relative = relative
    order = [0, 1] if random.random() < 0.5 else [1, 0]
    sign = -1.0 if random.random() < 0.15 else 1.0
    before = random.random() < 0.5
    columns = []
    for k in order:
        words = [pair[k], force] if before else [force, pair[k]]
        name = _join(random, words)
        made.names.append(_with_unit(random, name, unit) if stated else name)
        columns.append(sign * factor * made.force[("left", "right")[k]])
    if random.random() < 0.2:
        made.sides = (("left", "right")[order[0]],)
        del made.names[1], columns[1]
    return columns


def _plates(made: Table, random: np.random.Generator) -> list[np.ndarray]:
    up = str(random.choice(["z", "y"]))
    ahead, across = ("x", "y") if up == "z" else ("z", "x")
    style = int(random.integers(4))
    unit, factor = (("N", 1.0), ("kN", 1e-3))[int(random.random() < 0.15)]
    length, scale = (("m", 1.0), ("mm", 1e3))[int(random.integers(2))]
    stated = bool(random.random() < 0.7) or unit != "N"
    pair = ("left", "right") if random.random() < 0.6 else ("right", "left")
    columns = []
    for k, side in enumerate(pair):
        load = made.force[side]
        gone = np.clip(((made.time - made.begins[side][0]) % made.period) / made.stance, 0.0, 1.0)
        parts = {ahead: 0.2 * load * (gone - 0.5), across: (-0.04 if side == "left" else 0.04) * load, up: load}
        places = {ahead: 0.2 * gone, across: np.full_like(load, 0.1 if side == "left" else -0.1), up: 0.0 * load}
        for axis in "xyz":
            stem = (
                f"FP{k + 1}_F{axis}",
                f"Plate{k + 1}.F{axis.upper()}",
                f"{side}_F{axis}",
                f"{k + 1}_ground_force_v{axis}",
            )
            made.names.append(_with_unit(random, stem[style], unit) if stated else stem[style])
            columns.append(factor * parts[axis])
        for axis in "xyz":
            stem = (
                f"FP{k + 1}_COP{axis}",
                f"Plate{k + 1}.Cop{axis.upper()}",
                f"{side}_COP{axis}",
                f"{k + 1}_ground_force_p{axis}",
            )
            made.names.append(_with_unit(random, stem[style], length) if stated else stem[style])
            columns.append(scale * places[axis])
    if random.random() < 0.3:  # what is no load
        made.names += ["LHEE_x", "knee_angle_r"]
        columns += [1e3 + 100.0 * made.time, 30.0 * np.sin(made.time)]
    return columns


def _cells(made: Table, random: np.random.Generator) -> list[np.ndarray]:
    made.cells = int(random.integers(5, 17))
    shares = random.dirichlet(np.full(made.cells, 3.0))
    pair = _SIDES[int(random.integers(4))]
    word = str(random.choice(["", "sensor", "cell", "S", "P"]))
    unit, factor = (("N", 1.0), ("raw", 0.7), ("", 0.9))[int(random.integers(3))]
    made.raw = unit != "N"
    columns = []
    order = (0, 1) if random.random() < 0.5 else (1, 0)
    for k in order:
        for i in range(made.cells):
            name = _join(random, [pair[k], word, str(i + 1)])
            made.names.append(_with_unit(random, name, unit) if unit else name)
            columns.append(factor * shares[i] * made.force[("left", "right")[k]])
    return columns


def _places(made: Table, random: np.random.Generator) -> list[np.ndarray]:
    made.cells = int(random.integers(3, len(PLACES) + 1))
    shares = random.dirichlet(np.full(made.cells, 5.0))
    made.raw = True
    both = bool(random.random() < 0.5)
    made.sides = ("left", "right") if both else ("left",)
    columns = []
    for side in made.sides:
        for i in range(made.cells):
            made.names.append(f"{side}_{PLACES[i]}" if both else PLACES[i])
            columns.append(np.round(0.8 * shares[i] * made.force[side]))
    return columns


def _write(path, made, columns, rate, random, twist):
    """The text, with separators, decimal signs, times, comments, gaps and a twist drawn."""
    comma = bool(random.random() < 0.25)
    sign = str(random.choice([";", "\t"])) if comma else str(random.choice([",", ";", "\t"]))
    name, factor = _TIMES[int(random.integers(len(_TIMES)))]
    values, names = [factor * made.time, *columns], [name, *made.names]
    lines = []
    if random.random() < 0.25 and twist not in ("rows of either foot", "no names", "clock"):  # no times, but a rate
        values, names = columns, made.names
        lines.append(f"# rate: {rate:g} Hz")
    lines += ["# walk of somebody"] if random.random() < 0.2 else []
    timed = len(values) > len(columns)
    if twist == "units row" and made.kind in ("forces of feet", "plates"):
        cut = [([*n.rstrip(")]").replace("[", "(").split("("), ""])[:2] for n in names]
        lines.append(sign.join(n.strip() for n, _ in cut))
        names = [u.strip() or "-" for _, u in cut]
    elif twist == "groups" and made.kind == "sensors by place" and len(made.sides) == 2:
        n = made.cells
        lines.append(sign.join([""] * timed + ["left"] + [""] * (n - 1) + ["right"] + [""] * (n - 1)))
        names = names[:1] * timed + [p.partition("_")[2] for p in names[timed:]]
    elif twist == "no names" and made.kind == "cells":
        names = []
    elif twist == "counter":
        values, names = [np.arange(len(made.time)) + 1.0, *values], ["Sample", *names]
    elif twist == "other sensors":
        names += ["Acc_X (g)", "Gyro Z [deg/s]", "Temperature (C)", "Battery (V)"]
        values += [
            np.sin(7.0 * made.time),
            100.0 * np.cos(7.0 * made.time),
            30.0 + 0.0 * made.time,
            3.7 + 0.0 * made.time,
        ]
    elif twist == "totals" and made.kind == "cells":
        for side, half in zip(made.sides, (columns[: made.cells], columns[made.cells :]), strict=True):
            first = names[timed:][0 if side == made.sides[0] else made.cells]
            side = "left" if first.lower().startswith(("l", "li")) else "right"
            names, values = [*names, f"{side} total force"], [*values, np.sum(half, axis=0)]
    elif twist == "heading":
        lines += ["Export of a laboratory", f"Rate{sign}{rate:g}", "Operator: nobody", ""]
    lines += [sign.join(names)] if names else []
    table = np.column_stack(values)
    if twist == "rows of either foot" and made.kind == "sensors by place" and len(made.sides) == 2:
        n = made.cells
        lines[-1] = sign.join([names[0], "foot", *PLACES[:n]])
        table = np.array([[r[0], k, *r[1 + k * n : 1 + k * n + n]] for r in table for k in (0, 1)])
    lost = int(random.integers(50, len(made.time) - 50)) if random.random() < 0.2 and names else -9
    for i, row in enumerate(table.tolist()):
        cells = [f"{v:.6g}" if k or not timed else f"{v:.4f}" for k, v in enumerate(row)]
        if twist == "counter":
            cells[:2] = [f"{row[0]:.0f}", f"{row[1]:.4f}"]
        elif twist == "clock":
            seconds = 3600.0 * 8 + made.time[i]
            cells[0] = f"{int(seconds // 3600):02d}:{int(seconds // 60 % 60):02d}:{seconds % 60.0:06.3f}"
        if i in (lost, lost + 1):
            cells[-1] = str(random.choice(["", "NaN"]))
        text = sign.join(cells)
        lines.append(text.replace(".", ",") if comma else text)
    if twist == "rows of either foot" and made.kind == "sensors by place" and len(made.sides) == 2:
        begin = len(lines) - len(table)
        for i in range(begin, len(lines)):
            cells = lines[i].split(sign)
            cells[1] = "left" if cells[1] in ("0", "0.0") else "right"
            lines[i] = sign.join(cells)
    if (
        twist == "blanks"
        and not comma
        and all(" " not in n for n in names)
        and not any(x.startswith("#") for x in lines)
    ):
        lines = [x.replace(sign, "  ") for x in lines] if lost < 0 else lines
    end = str(random.choice(["\n", "\r\n"]))
    made.twist = twist
    made.note = f"{made.kind}, {twist}, {rate:g} Hz, {'comma' if comma else 'point'} {sign!r}, {names[:4]}"
    path.write_bytes((end.join(lines) + end).encode(str(random.choice(["utf-8", "utf-8-sig", "latin-1"]))))
