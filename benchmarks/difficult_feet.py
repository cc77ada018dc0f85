"""Shoes for difficult feet, each in small rotations: the table of difficult_feet.md.

`python benchmarks/difficult_feet.py [TURNS] [FOOT...]` builds what is missing in difficult_feet.csv, the left shoe of
each foot (tests/shoes/foot_family.py) in so many rotations (the first is none), and writes the table; 0 only writes it.
A shoe that passes its own checks is checked by tests/shoes/shoe_witness.py, which shares no code with it.

`python benchmarks/difficult_feet.py plans [TURNS] [FOOT...]` makes plans alone, for each printing process, and prints
the taxels that are active at half the weight with seats that scatter as the process's do, and the checks that fail.

An outcome is `holds`; `refused`, not a foot; `reported`, a shoe whose checks do not hold (exit code 1); `hidden`, one
whose checks hold and the witness finds a fault; or `crashed`, any other exception.
"""

import sys
import tempfile
import time
from collections import Counter
from itertools import product
from pathlib import Path
from statistics import median
from typing import Any

from resumable import append_row, commit, rows_of, write_table

from plantar.bench.tables import markdown_table
from plantar.errors import PlantarError
from plantar.shoes import ShoeParameters, build_shoe, export_shoe
from plantar.shoes.checks.check import check_plan
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.materials import PROCESSES
from plantar.shoes.plan.strength import load_case
from plantar.shoes.plan.touching import check_touching

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent / "tests" / "shoes"))
from foot_family import FAMILY, REFUSED, TURNS, small_turns, turned  # noqa: E402
from shoe_witness import Witness  # noqa: E402

TABLE = FOLDER / "difficult_feet.csv"
COLUMNS = ("foot", "turn", "outcome", "taxels", "flat_percent", "half_percent", "undercut_mm2", "blind_rim_mm")
COLUMNS += ("seconds", "commit", "reason")
OUTCOMES = ("holds", "refused", "reported", "hidden", "crashed")
LONG_BED = {"large": {"bed_length": 500.0}}
"""Parameters of feet that the usual printer has no room for."""


def shoe_of(name: str, turn: int) -> dict[str, Any]:
    """The row of one foot in one rotation."""
    start = time.perf_counter()
    row: dict[str, Any] = dict.fromkeys(COLUMNS, "") | {"foot": name, "turn": turn, "commit": commit()}
    try:
        foot = foot_from_triangles(name, turned(FAMILY[name](), *small_turns(name)[turn]), where=name)
        build = build_shoe(foot, side="left", parameters=ShoeParameters(**LONG_BED.get(name, {})))
        with tempfile.TemporaryDirectory() as folder:
            report = export_shoe(build, folder)
            assert foot.triangles is not None
            faults = Witness(Path(folder), foot.triangles).problems() if report.holds else []
        checked = report.checks["left"]
        share = build.load_share
        failed = [f"{c.name}: {c.value} ({c.allowed})" for c in checked.checks if not c.holds]
        row |= {
            "outcome": "reported" if failed else "hidden" if faults else "holds",
            "taxels": len(build.shoes[0].layout),
            "flat_percent": round(100.0 * share.flat, 1),
            "half_percent": round(100.0 * share.half, 1),
            "undercut_mm2": checked.mounting.undercut,
            "blind_rim_mm": round(build.shoes[0].plan.blind_rim, 1),
            "reason": "; ".join(failed + faults),
        }
    except PlantarError as error:
        row |= {"outcome": "refused", "reason": str(error)}
    except Exception as error:  # of every kind: that there is none is what is counted
        row |= {"outcome": "crashed", "reason": f"{type(error).__name__}: {error}"}
    return row | {"seconds": round(time.perf_counter() - start, 1)}


def rows() -> dict[tuple[str, int], dict[str, str]]:
    return {(row["foot"], int(row["turn"])): row for row in rows_of(TABLE)}


def run(turns: int, names: list[str]) -> None:
    for turn, name in product(range(turns), names or sorted(FAMILY)):
        if (name, turn) not in rows():
            row = shoe_of(name, turn)
            append_row(TABLE, COLUMNS, row)
            print(*(row[c] for c in ("foot", "turn", "outcome", "seconds", "reason")), flush=True)


def plans(turns: int, names: list[str]) -> None:
    """Prints a row a process: plans, refused, whose checks hold; least active and area, largest CoP error."""
    print("| process | scatter mm | plans | refused | hold | active % | area % | CoP mm | fails |")
    print("|---|---|---|---|---|---|---|---|---|")
    for process in PROCESSES:
        found = []
        failed = Counter[str]()
        refused = 0
        hold = 0
        for name, turn in product(names or sorted(set(FAMILY) - REFUSED), range(turns)):
            parameters = ShoeParameters(process=process, **LONG_BED.get(name, {}))
            try:
                foot = foot_from_triangles(name, turned(FAMILY[name](), *small_turns(name)[turn]), where=name)
                build = build_shoe(foot, side="left", parameters=parameters, layout_only=True)
            except PlantarError:
                refused += 1
                continue
            plan = build.shoes[0].plan
            found.append(check_touching(plan, load_case(foot, build.parameters), build.parameters))
            bad = [check.name for check in check_plan(plan, build) if not check.holds]
            hold += not bad
            failed.update(f"{name}: {check}" for check in bad)
        shares = [100.0 * min(share) for share in ([t.active for t in found], [t.area for t in found])]
        fails = "; ".join(f"{text} ({count})" for text, count in failed.items())
        cells = [process, f"{found[0].scatter:g}", len(found) + refused, refused, hold]
        cells += [f"{shares[0]:.1f}", f"{shares[1]:.1f}", f"{max(t.cop_error for t in found):.2f}", fails]
        print("|", " | ".join(map(str, cells)), "|", flush=True)


def report() -> None:
    found = rows()
    lines = []
    for name in sorted({name for name, _ in found}):
        own = [row for (foot, _), row in found.items() if foot == name]
        outcomes = Counter(row["outcome"] for row in own)
        built = [row for row in own if row["taxels"]]
        cells = "-"
        span = "-"
        if built:
            least, most = (f([int(row["taxels"]) for row in built]) for f in (min, max))
            cells = f"{least} to {most}"
            span = ", ".join(f"{min(float(row[c]) for row in built):.0f}" for c in ("flat_percent", "half_percent"))
        spent = median(float(row["seconds"]) for row in own)
        lines.append((name, len(own), *(outcomes[kind] for kind in OUTCOMES), cells, span, f"{spent:.0f}"))
    head = ("foot", "turns", *OUTCOMES, "taxels", "flat, half %", "s")
    write_table(FOLDER / "difficult_feet.md", [markdown_table(head, lines)])


if __name__ == "__main__":
    if sys.argv[1:2] == ["plans"]:
        sys.exit(plans(int(sys.argv[2]) if len(sys.argv) > 2 else 1, sys.argv[3:]))
    run(int(sys.argv[1]) if len(sys.argv) > 1 else TURNS, sys.argv[2:])
    report()
