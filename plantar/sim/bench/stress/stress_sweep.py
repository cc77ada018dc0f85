"""Many stress runs, a row each in a growing table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from plantar.bench.tables import GrowingTable
from plantar.errors import InputError
from plantar.sim.bench.stress.scenario import draw_scenario
from plantar.sim.bench.stress.stress_run import FAILURES, run_scenario

__all__ = ["measure_stress", "stress_loop_text"]

_COLUMNS = ("number", "scene", "robot", "outcome", "detail", "time_s")
_TABLE = "stress.csv"


def measure_stress(
    folder: Path, count: int, first: int = 0, progress: Callable[[float, str], None] | None = None
) -> dict[str, Any]:
    """Run the scenarios that are not in stress.csv yet.

    Args:
        folder: Of the table; made if needed.
        count: Number of scenarios, 1 or more.
        first: Number of the first one.
        progress: Called with the fraction done and a text.

    Returns:
        Counts of each outcome, the failures, and the table's name.

    Raises:
        InputError: If there is not at least one scenario, or the file is no such table.
    """
    if count < 1:
        raise InputError(f"stress run of {count} scenarios; allowed: 1 or more")
    folder.mkdir(parents=True, exist_ok=True)
    table = GrowingTable(folder / _TABLE, _COLUMNS, "stress runs")
    rows = {int(row["number"]): row for row in table.rows}
    wanted = range(first, first + count)
    for done, number in enumerate(wanted):
        if number in rows:
            continue
        scenario = draw_scenario(number)
        found = run_scenario(scenario)
        row = (number, scenario.scene, scenario.robot, found.kind, found.detail, round(found.time, 3))
        table.add(dict(zip(_COLUMNS, row, strict=True)))
        rows[number] = table.rows[-1]
        if progress is not None:
            failures = sum(r["outcome"] in FAILURES for r in rows.values())
            progress((done + 1) / count, f"scenario {number}, {failures} failures")
    own = [rows[number] for number in wanted]
    return {
        "scenarios": count,
        "first": first,
        "outcomes": dict(Counter(row["outcome"] for row in own).most_common()),
        "simulated_s": round(sum(float(row["time_s"]) for row in own), 1),
        "failures": [row for row in own if row["outcome"] in FAILURES],
        "files": [_TABLE],
    }


def stress_loop_text(result: dict[str, Any]) -> str:
    """The outcomes as text."""
    lines = [f"{result['scenarios']} scenarios from number {result['first']} on, {result['simulated_s']} s simulated"]
    lines += [f"{count:8} {outcome}" for outcome, count in result["outcomes"].items()]
    lines += [f"FAILED {r['number']}, {r['scene']}, {r['robot']}: {r['detail']}" for r in result["failures"]]
    return "\n".join(lines)
