"""Counts that README and pages state, taken from their tables: `python benchmarks/counts_in_prose.py`.

A count stands between comments that name its rows and are not seen where the page is read:

    <!-- walks.csv: beam, h1 -->8 of 8<!-- . -->

are the completed runs of the case `beam` on h1; without a robot, on all. `fallen` or `not completed` after the file's
name count those; a case of `blind_footholds` is a policy, a kind and its value. The command writes them anew from the
rows; a test asks that nothing changes by it.
"""

import re
from pathlib import Path

from resumable import FOLDER, Row, latest, rows_of

PAGES = [FOLDER.parent / "README.md", *sorted((FOLDER.parent / "docs").rglob("*.md")), *sorted(FOLDER.glob("*.md"))]
_COUNT = re.compile(r"(<!-- (\w+)\.csv(?: (fallen|not completed))?: (.+?)(?:, (h1|hrp2kai))? -->).*?(<!-- \. -->)")


def counted(rows: list[Row], what: str) -> int:
    """How many of the rows are completed, or `what` says."""
    if what == "fallen":
        return sum(r["fell"] in ("True", "1") for r in rows)
    completed = sum(r["completed"] == "True" for r in rows)
    return len(rows) - completed if what else completed


def _latest(rows: list[Row]) -> list[Row]:
    """The row that counts of each run; policies and public robots have one row a run."""
    if rows and "policy" in rows[0]:
        return [{**r, "case": f"{r['policy']} {r['kind']} {r['value']}"} for r in rows]
    return latest(rows) if rows and "plant" in rows[0] else rows


def written(text: str, folder: Path = FOLDER) -> str:
    """The text with each of its counts as the rows have it.

    Raises:
        ValueError: If there is no such row.
    """

    def count(found: re.Match[str]) -> str:
        opening, table, what, case, robot, closing = found.groups()
        rows = _latest(rows_of(folder / f"{table}.csv"))
        mine = [r for r in rows if r["case"] == case and robot in (None, r["robot"])]
        if not mine:
            raise ValueError(f"{table}.csv has no row of {case}{f' on {robot}' if robot else ''}")
        return f"{opening}{counted(mine, what)} of {len(mine)}{closing}"

    return _COUNT.sub(count, text)


if __name__ == "__main__":
    for page in PAGES:
        old = page.read_text(encoding="utf-8")
        if (new := written(old)) != old:
            page.write_text(new, encoding="utf-8")
            print(page.relative_to(FOLDER.parent))
