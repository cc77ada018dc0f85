"""Cells that a table's names show to be missing: what their forces would add is reported, and not guessed."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side
from plantar.formats.field_names import Heading

_COUNTED = 4  # Numbered cells of a foot from which a gap in their numbers is reported
_LACKING = 0.34  # Share of them that may be lacking


def report_missing_cells(
    table: NDArray[np.float64],
    headings: Sequence[Heading],
    cells: Sequence[int],
    columns: Sequence[int],
    warnings: list[str],
) -> None:
    """Add to `warnings` numbers that a foot leaves out, cells of one foot alone, and columns without a name.

    `table`: numbers (n, k); `headings`: of its columns; `cells`: columns of cells; `columns`: all but times.
    """
    by_side = {side: [i for i in cells if headings[i].side == side] for side in (None, *SIDES)}
    for side, own in by_side.items():
        _report_gaps([headings[i] for i in own], side, warnings)
    named = {side: {_label(headings[i]): i for i in by_side[side]} for side in SIDES}
    for side in SIDES:
        others = named[other_side(side)]
        lacking = [label for label in others if label not in named[side]]
        if named[side] and 0 < len(lacking) <= _LACKING * len(others):
            share = _share(table, [others[label] for label in lacking], list(others.values()))
            warnings.append(
                f"the {side} foot has no cell {', '.join(lacking)}, as the other one has: its forces are up to "
                f"{share:.0f} % too small, and its contacts too short (--columns names cells)"
            )
    for i in columns:
        heading = headings[i]
        if i in cells or heading.words or heading.side or heading.number is not None:
            continue
        share = max((_share(table, [i], [*own, i]) for own in by_side.values() if own), default=0.0)
        if share > 0.0:
            warnings.append(
                f"column {i + 1} has no name: left out; if it is a cell, forces are up to {share:.0f} % too small, and "
                "contacts too short (--columns names it)"
            )


def _label(heading: Heading) -> str:
    return f"{heading.words} {'' if heading.number is None else heading.number}".strip()


def _share(table: NDArray[np.float64], part: Sequence[int], whole: Sequence[int]) -> float:
    """Largest force of some columns in percent of that of all."""
    all_of_it = float(np.nanmax(np.nansum(table[:, whole], axis=1), initial=0.0))
    some = float(np.nanmax(np.nansum(table[:, part], axis=1), initial=0.0))
    return 100.0 * some / all_of_it if all_of_it > 0.0 else 0.0


def _report_gaps(cells: Sequence[Heading], side: Side | None, warnings: list[str]) -> None:
    numbers = {cell.number for cell in cells if cell.number is not None}
    lacking = sorted(set(range(min(numbers, default=0), max(numbers, default=0))) - numbers)
    if len(numbers) >= _COUNTED and 0 < len(lacking) <= _LACKING * len(numbers):
        shown = ", ".join(map(str, lacking))
        warnings.append(
            f"{f'the {side} foot has' if side else 'there are'} cells {min(numbers)} to {max(numbers)} without "
            f"{shown}: forces are about {100.0 * len(lacking) / (len(numbers) + len(lacking)):.0f} % too small, "
            "if these are cells (--columns names them)"
        )
