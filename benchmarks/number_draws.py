"""Vary all tuned numbers of a walk at once: `python benchmarks/number_draws.py [FIRST LAST | alone NUMBERS | page]`.

Each draw multiplies every number on the control path whose reason is "chosen" or "measured" (`tools/walk_numbers.py`)
by a factor of its own, between 0.8 and 1.2, and walks one of six scenes on both robots, on one drawn plant. Factors are
independent, so the correlation of a number's factor with a figure of the walks shows what that number does, as far as
it is seen through the others. `alone` then moves each of the first NUMBERS of that list to both ends, nothing else, on
five drawn plants of the scene where it shows most. Compiled kernels keep their numbers. Stopped counts go on.
"""

from __future__ import annotations

import ast
import hashlib
import importlib.machinery
import json
import math
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from resumable import FOLDER, PLANTS, append_row, commit, drawn_seeds, largest_impact, rows_of, write_table

sys.path.insert(0, str(FOLDER.parent / "tools"))

from walk_numbers import WalkNumber, numbers_on

ROBOTS = ("h1", "hrp2kai")
SCENES = ("flat", "stones", "obstacle", "tilt", "push", "feasibility-2")
SPAN = 0.2
PLANTS_ALONE = 5
RATES = ("period", "physics_period", "skin_rate")
"""Settings that must divide each other, so that they are not varied."""
TABLE = FOLDER / "number_draws.csv"
ALONE = FOLDER / "number_alone.csv"
PAGE = FOLDER / "number_draws.md"
SINGLE = "Alone at both ends, on five drawn plants of the scene where they show most (impact in BW, margin in mm):"
FIGURES = {"completed": "completed", "impact": "largest impact [BW]", "margin": "smallest ZMP margin [mm]"}
COLUMNS = ("draw", "scene", "robot", "completed", "fell", "impact", "margin", "failed", "commit")
COLUMNS_ALONE = ("number", "factor", "scene", "robot", "seed", *COLUMNS[3:])
SETTINGS = ("number", "number_setting", "share", "fixed", "whole")


def tuned() -> dict[str, WalkNumber]:
    """The numbers that are varied, by a name that is theirs alone."""
    found: dict[str, WalkNumber] = {}
    for n in numbers_on():
        compiled = n.path.startswith("plantar/kernels/")
        if n.reason in ("chosen", "measured") and not compiled and n.name not in RATES:
            name = n.name if n.kind != "literal" else f"{n.value} in {n.name}"
            key = f"{n.path.removeprefix('plantar/')} {name}"
            found[key if key not in found else f"{key} ({n.line})"] = n
    return found


def factors(draw: int, names: Sequence[str]) -> dict[str, float]:
    """Of each number in a draw."""
    digest = hashlib.sha256(f"numbers {draw}".encode()).digest()
    return dict(zip(names, np.random.default_rng(list(digest)).uniform(1 - SPAN, 1 + SPAN, len(names)), strict=True))


class Scaled(importlib.machinery.SourceFileLoader):
    """Loads a module with some of its numbers multiplied."""

    def __init__(self, name: str, path: str, numbers: Sequence[tuple[WalkNumber, float]]) -> None:
        super().__init__(name, path)
        self._numbers = numbers

    def get_code(self, fullname: str) -> Any:
        source = self.get_data(self.path)
        tree = ast.parse(source)
        scale(tree, source.decode(), self._numbers)
        return compile(ast.fix_missing_locations(tree), self.path, "exec")


def scale(tree: ast.Module, source: str, numbers: Sequence[tuple[WalkNumber, float]]) -> int:
    """Multiply the numbers of one file in its tree; returns how many were found."""
    named = {n.line: factor for n, factor in numbers if n.kind != "literal"}
    literals = {(n.line, n.value): factor for n, factor in numbers if n.kind == "literal"}
    done = 0
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign | ast.AnnAssign) and node.lineno in named and node.value is not None:
            node.value = _multiplied(node.value, named[node.lineno])
            done += 1
        elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
            factor = literals.get((node.lineno, ast.get_source_segment(source, node) or ""))
            if factor is not None:
                node.value = _whole_or_real(node.value, factor)
                done += 1
    return done


def _multiplied(value: ast.expr, factor: float) -> ast.expr:
    """An assigned expression, multiplied; a setting's default stays within its range."""
    if isinstance(value, ast.Constant):
        return ast.Constant(_whole_or_real(value.value, factor)) if type(value.value) in (int, float) else value
    if isinstance(value, ast.Tuple):
        return ast.Tuple([_multiplied(each, factor) for each in value.elts], value.ctx)
    if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id in SETTINGS:
        default = _multiplied(value.args[0], factor)
        ends = [a.value if isinstance(a, ast.Constant) else None for a in value.args[2:4]]
        if isinstance(default, ast.Constant) and len(ends) == 2 and None not in ends:
            default = ast.Constant(min(max(default.value, ends[0]), ends[1]))  # type: ignore[type-var, arg-type]
        return ast.Call(value.func, [default, *value.args[1:]], value.keywords)
    if isinstance(value, ast.Dict):
        return value
    return ast.BinOp(value, ast.Mult(), ast.Constant(factor))


def _whole_or_real(value: Any, factor: float) -> float | int:
    return round(value * factor) if type(value) is int else value * factor


class Finder:
    """Imports modules with their numbers multiplied."""

    def __init__(self, moved: Mapping[str, float]) -> None:
        known = tuned()
        self._files: dict[str, list[tuple[WalkNumber, float]]] = {}
        for name, factor in moved.items():
            number = known[name]
            module = number.path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
            self._files.setdefault(module, []).append((number, factor))

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> Any:
        if name not in self._files:
            return None
        spec = importlib.machinery.PathFinder.find_spec(name, path, target)
        if spec is not None and spec.origin is not None:
            spec.loader = Scaled(name, spec.origin, self._files[name])
        return spec


def walked(moved: Mapping[str, float], scene: str, robot: str, seed: int) -> dict[str, Any]:
    """A walk's outcome with some numbers multiplied; of this process, which then keeps them."""
    sys.meta_path.insert(0, Finder(moved))  # type: ignore[arg-type]
    from plantar.sim.run.runner import Simulation
    from plantar.sim.run.scene import load_scene

    simulation = Simulation(load_scene(scene, PLANTS["ordinary"], robot), seed)
    out = simulation.run()
    return {
        "completed": out["completed"],
        "fell": out["fell"],
        "impact": largest_impact(simulation, out),
        "margin": round(1e3 * float(out["zmp_margin_min_m"]), 2),
        "failed": " ".join(r["criterion"] for r in out["reasons"]),
    }


def in_process(moved: Mapping[str, float], scene: str, robot: str, seed: int) -> dict[str, Any]:
    """`walked` in a process of its own; one that raises counts as not completed, with its last line."""
    given = json.dumps([dict(moved), scene, robot, seed])
    done = subprocess.run([sys.executable, __file__, "walk"], input=given, capture_output=True, text=True, check=False)
    if done.returncode:
        return {"completed": False, "fell": "", "failed": (done.stderr.strip().splitlines() or ["no word"])[-1][:120]}
    return dict(json.loads(done.stdout))


def draws(first: int, last: int) -> None:
    """Walk the draws from `first` up to `last`; draw 0 leaves every number as it is, in each scene."""
    names, made = list(tuned()), commit()
    seed = drawn_seeds("numbers", 1)[0]
    done = {(r["draw"], r["scene"], r["robot"]) for r in rows_of(TABLE)}
    for draw in range(first, last):
        for scene in SCENES if draw == 0 else (SCENES[draw % len(SCENES)],):
            for robot in ROBOTS:
                if (str(draw), scene, robot) in done:
                    continue
                moved = {} if draw == 0 else factors(draw, names)
                row = in_process(moved, scene, robot, seed)
                append_row(TABLE, COLUMNS, {"draw": draw, "scene": scene, "robot": robot, "commit": made, **row})
                print(draw, scene, robot, row, file=sys.stderr, flush=True)


def alone(count: int) -> None:
    """Move each of the numbers that show most to both ends, nothing else."""
    made, ranked = commit(), effects(rows_of(TABLE))[:count]
    done = {tuple(r[c] for c in COLUMNS_ALONE[:5]) for r in rows_of(ALONE)}
    for name, scene, *_ in ranked:
        for seed in drawn_seeds("numbers alone", PLANTS_ALONE):
            for factor in (1.0 - SPAN, 1.0, 1.0 + SPAN):
                for robot in ROBOTS:
                    key = (name if factor != 1.0 else "-", f"{factor:g}", scene, robot, str(seed))
                    if key in done:
                        continue
                    done.add(key)
                    row = in_process({} if factor == 1.0 else {name: factor}, scene, robot, seed)
                    append_row(
                        ALONE, COLUMNS_ALONE, {**dict(zip(COLUMNS_ALONE[:5], key, strict=True)), "commit": made, **row}
                    )
                    print(*key, row, file=sys.stderr, flush=True)


Effect = tuple[str, str, str, float, float]
"""A number, the scene and the figure where it shows most, its slope over +20 % and its t."""


def effects(rows: Sequence[Mapping[str, str]]) -> list[Effect]:
    """What each number does, the surest first: correlations within scenes and robots."""
    names = list(tuned())
    drawn = [r for r in rows if r["draw"] != "0"]
    if not drawn:
        raise SystemExit(f"{TABLE.name} has no draws yet; run number_draws.py 0 200 first")
    known = {draw: np.array(list(factors(int(draw), names).values())) for draw in {r["draw"] for r in drawn}}
    x = np.array([known[r["draw"]] for r in drawn])
    x = (x - 1.0) / SPAN
    groups = [f"{r['scene']} {r['robot']}" for r in drawn]
    best: dict[str, Effect] = {}
    for figure in FIGURES:
        y = np.array([_figure(r, figure) for r in drawn])
        use = np.isfinite(y)
        for group in set(groups):
            mine = use & (np.array(groups) == group)
            y[mine] -= y[mine].mean() if mine.any() else 0.0
        xs, ys = x[use] - x[use].mean(axis=0), y[use]
        spread = math.sqrt(float(ys @ ys))
        if spread == 0.0:
            continue
        r = xs.T @ ys / np.linalg.norm(xs, axis=0) / spread
        t = r * np.sqrt((len(ys) - 2) / np.maximum(1.0 - r * r, 1e-12))
        slope = xs.T @ ys / (xs * xs).sum(axis=0)
        scenes = np.array([row["scene"] for row in drawn])[use]
        for i, name in enumerate(names):
            if name not in best or abs(t[i]) > abs(best[name][4]):
                pulls = {s: abs(float(xs[scenes == s, i] @ ys[scenes == s])) for s in SCENES}
                best[name] = (name, max(pulls, key=lambda s: pulls[s]), figure, float(slope[i]), float(t[i]))
    return sorted(best.values(), key=lambda e: -abs(e[4]))


def _figure(row: Mapping[str, str], figure: str) -> float:
    """Of a row; NaN where the walk has not one that can be compared."""
    if figure == "completed":
        return float(row["completed"] == "True")
    return float(row[figure]) if row["fell"] == "False" and row[figure] else math.nan


def page() -> None:
    from plantar.bench.intervals import wilson_interval
    from plantar.bench.tables import markdown_table

    rows = rows_of(TABLE)
    drawn, plain = [r for r in rows if r["draw"] != "0"], [r for r in rows if r["draw"] == "0"]
    lines = []
    for scene in SCENES:
        for robot in ROBOTS:
            mine = [[r for r in some if (r["scene"], r["robot"]) == (scene, robot)] for some in (plain, drawn)]
            cells: list[Any] = [scene, robot]
            for some in mine:
                good = sum(r["completed"] == "True" for r in some)
                cells.append(f"{good}/{len(some)}")
            for figure in ("impact", "margin"):
                for some in mine:
                    found = [v for r in some if math.isfinite(v := _figure(r, figure))]
                    cells.append(f"{np.median(found):.3g}" if found else "-")
            lines.append(cells)
    head = ("scene", "robot", "completed as it is", "of draws", "impact as it is [BW]", "of draws")
    table = markdown_table((*head, "margin as it is [mm]", "of draws"), lines)
    good = sum(r["completed"] == "True" for r in drawn)
    low, high = wilson_interval(good, len(drawn))
    names, found = tuned(), effects(rows)
    sure = _sure(len(names) * len(FIGURES), len(drawn) - 2)
    told = [(n, names[n].value, names[n].unit, f, f"{slope:+.3g}", f"{t:+.1f}", s) for n, s, f, slope, t in found[:20]]
    made = sorted({r["commit"] for r in rows})
    write_table(
        PAGE,
        [
            f"{len(names)} numbers, {len({r['draw'] for r in drawn})} draws, {len(drawn)} walks at {', '.join(made)}: "
            f"{good} completed ({100 * low:.0f} to {100 * high:.0f} %).",
            "",
            table,
            "",
            f"The surest twenty. If figures scattered normally none had a |t| above {sure:.1f} by chance (5 %).",
            "",
            markdown_table(("number", "value", "unit", "what it moves", "by +20 %", "t", "most in"), told),
        ],
    )
    single = rows_of(ALONE)
    lines = []
    for name, scene, *_ in found[:20]:
        mine = [r for r in single if r["number"] == name]
        same = [r for r in single if r["number"] == "-" and r["scene"] == scene]
        if mine:
            parts = [[r for r in mine if r["factor"] == f] for f in ("0.8", "1.2")]
            cells = [f"{sum(r['completed'] == 'True' for r in p)}/{len(p)}" for p in (parts[0], same, parts[1])]
            lines.append((name, scene, *cells, *(_between(p, same) for p in parts)))
    if lines:
        heads = ("number", "scene", "0.8: completed", "1", "1.2", "0.8: impact, margin", "1.2: impact, margin")
        write_table(PAGE, [SINGLE, "", markdown_table(heads, lines)], "alone")


def _between(moved: Sequence[Mapping[str, str]], same: Sequence[Mapping[str, str]]) -> str:
    """Median change of impact in BW and of margin in mm, run by run."""
    known = {(r["robot"], r["seed"]): r for r in same}
    texts = []
    for figure in ("impact", "margin"):
        pairs = [_figure(r, figure) - _figure(known[r["robot"], r["seed"]], figure) for r in moved]
        pairs = [p for p in pairs if math.isfinite(p)]
        texts.append(f"{np.median(pairs):+.2g}" if pairs else "-")
    return ", ".join(texts)


def _sure(tests: int, freedom: int) -> float:
    from scipy.stats import t

    return float(t.isf(0.025 / tests, freedom))


def main(arguments: Sequence[str]) -> None:
    if arguments[:1] == ["walk"]:
        print(json.dumps(walked(*json.load(sys.stdin))))
        return
    if arguments[:1] == ["alone"]:
        alone(int(arguments[1]))
    elif arguments[:1] != ["page"]:
        draws(*(int(a) for a in arguments or ("0", "200")))
    page()


if __name__ == "__main__":
    main(sys.argv[1:])
