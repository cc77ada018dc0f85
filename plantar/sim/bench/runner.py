"""Runs a kind of `plantar bench`: each case once, its rows in a table, a page and bench.json."""

import json
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import fields
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, NamedTuple

from plantar.bench.kind import BenchOptions, Case, Kind, Row
from plantar.bench.page import tables_text, write_page
from plantar.bench.tables import write_rows
from plantar.common.atomic import output_folder, write_text
from plantar.common.console.command import file_lines
from plantar.common.console.progress import Progress, part_of, progress_bar
from plantar.common.optional_library import need_libraries
from plantar.common.row_table import RowTable
from plantar.errors import InputError
from plantar.kernels import need_compiled
from plantar.sim.libraries import LIBRARIES

KINDS = {
    "kernels": "plantar.bench.kernels:KERNELS",
    "scenes": "plantar.sim.bench.scenes.scenes_report:SCENES",
    "skip": "plantar.sim.bench.skipping:SKIPPING",
    "stress": "plantar.sim.bench.stress.stress_run:STRESS",
    "footholds": "plantar.sim.bench.footholds.measure_footholds:FOOTHOLDS",
}
"""Where each kind is; loaded when it runs."""

ALL = ("kernels", "skip")
"""Kinds that `all` runs."""

TAKEN_BY = {
    "scenarios": ("stress",),
    "first": ("stress",),
    "scene": ("scenes", "footholds"),
    "robot": ("scenes", "footholds"),
    "policy": ("footholds",),
    "seeds": ("footholds",),
    "quick": ("all", *KINDS),
}
"""Kinds that take an option."""


class Benched(NamedTuple):
    """Plain JSON values with written files under "files", the tables as text, and failures, a line each."""

    result: dict[str, Any]
    text: str
    failures: tuple[str, ...]


def run_bench(what: str, options: BenchOptions, output: Path) -> Benched:
    """Runs the kind `what`, or "all", with `options`, and writes its files into `output`.

    Raises:
        InputError: If kind or option is wrong.
        DependencyError: If a library is missing.
    """
    allowed = (*KINDS, "all")
    if what not in allowed:
        wrong = f"cannot measure '{what}'" if what else "give what to measure: plantar bench kernels"
        raise InputError(f"{wrong}; allowed: {', '.join(allowed)}")
    _check_options(what, options)
    need_libraries("sim", *(("scipy",) if what == "kernels" else LIBRARIES))
    if what != "kernels":
        need_compiled("walking")
    kinds: dict[str, Kind] = {name: resolve_name(KINDS[name]) for name in (ALL if what == "all" else (what,))}
    with progress_bar() as progress:
        found = {
            name: run_kind(kind, options, output, part_of(progress, i / len(kinds), 1.0 / len(kinds)))
            for i, (name, kind) in enumerate(kinds.items())
        }
    files = [file for one in found.values() for file in one.result.pop("files")]
    result: dict[str, Any] = {name: one.result for name, one in found.items()}
    if len(found) == 1 and kinds[what].resumes:
        result = found[what].result
    result["files"] = [*files, str(output / "bench.json")]
    write_text(output / "bench.json", json.dumps(result, indent=1) + "\n")
    failures = tuple(line for one in found.values() for line in one.failures)
    text = "\n\n".join(one.text for one in found.values())
    return Benched(result, text + file_lines(result["files"]), failures)


def _check_options(what: str, options: BenchOptions) -> None:
    for option in fields(options):
        takers = TAKEN_BY[option.name]
        if getattr(options, option.name) != option.default and what not in takers:
            raise InputError(f"--{option.name} is for {' and '.join(takers)}, not '{what}': plantar bench {takers[0]}")


def run_kind(kind: Kind, options: BenchOptions, output: Path, progress: Progress) -> Benched:
    """Runs the cases of a `kind` whose rows are missing, and writes table and page into `output` (made if needed)."""
    cases = kind.cases(options)
    with ExitStack() as stack:
        if kind.resumes:
            output.mkdir(parents=True, exist_ok=True)
            folder = output
            rows = _continued(kind, cases, folder, progress)
        else:
            folder = stack.enter_context(output_folder(output))
            rows = _measured(kind, cases, progress)
            write_rows(folder / kind.table, [_flat(row) for row in rows])
        finding = kind.find(rows, options)
        names = dict.fromkeys([*write_page(folder, kind, finding), kind.table])
    files = [str(output / name) for name in names]
    return Benched({**finding.result, "files": files}, tables_text(finding), tuple(finding.failures))


def _continued(kind: Kind, cases: Sequence[Case], folder: Path, progress: Progress) -> list[Row]:
    """All rows of the table, after the missing cases."""

    def key(row: Row) -> tuple[str, ...]:
        return tuple(row[name] for name in kind.keys)

    with RowTable(folder / kind.table, (*kind.keys, *kind.columns), key) as table:
        for number, case in enumerate(cases):
            progress(number / len(cases), ", ".join(case.key))
            if case.key not in table.rows:
                for row in case.measure():
                    table.append({**_named(kind, case), **row})
        return list(table.rows.values())


def _measured(kind: Kind, cases: Sequence[Case], progress: Progress) -> list[Row]:
    rows: list[Row] = []
    for number, case in enumerate(cases):
        progress(number / len(cases), ", ".join(case.key))
        rows += [{**_named(kind, case), **row} for row in case.measure()]
    return rows


def _named(kind: Kind, case: Case) -> dict[str, str]:
    return dict(zip(kind.keys, case.key, strict=True))


def _flat(row: Row) -> Row:
    """Cells of a row: the values of a nested table under its name."""
    cells: dict[str, Any] = {}
    for name, value in row.items():
        cells |= {f"{name}: {key}": inner for key, inner in value.items()} if isinstance(value, dict) else {name: value}
    return cells
