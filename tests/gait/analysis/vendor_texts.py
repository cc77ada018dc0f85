"""Walks written as vendors' programs write them, in the variations that locale, operator and transfer make."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.formats.recorded_layouts import grid_cells
from plantar.formats.units import PASCALS
from plantar.layouts.layout import SoleLayout

from .walks import MadeWalk


@dataclass(frozen=True)
class Writing:
    """How a text is written.

    Attributes:
        sep: The sign between numbers.
        comma: Decimal commas.
        end: Line ends.
        encoding: Of the text.
        unit: Of the pressures, by its plain name.
        sides: Feet that are written.
        short: Leave out all of a header that can be left out.
        decimals: Of times in s.
        seconds: Length in s of the unit of the times that the file does not name.
    """

    sep: str = "\t"
    comma: bool = False
    end: str = "\n"
    encoding: str = "utf-8"
    unit: str = "kpa"
    sides: tuple[Side, ...] = SIDES
    short: bool = False
    decimals: int = 5
    seconds: float = 1.0

    def number(self, value: float, decimals: int = 5) -> str:
        """A number without zeros at its end."""
        text = f"{value:.{decimals}f}"
        text = text.rstrip("0").rstrip(".") if "." in text else text
        return text.replace(".", ",") if self.comma else text

    def row(self, values: Sequence[float]) -> str:
        """Numbers in a row."""
        return self.sep.join(self.number(v) for v in values)

    def bytes(self, lines: Sequence[str]) -> bytes:
        """The text."""
        return (self.end.join(lines) + self.end).encode(self.encoding)


def _pressures(walk: MadeWalk, side: Side, how: Writing) -> NDArray[np.float64]:
    foot = walk.recording.feet[side]
    return foot.force / (foot.layout.areas * PASCALS[how.unit])


def pedar(walk: MadeWalk, how: Writing, times: NDArray | None = None, frames: Sequence[int] | None = None) -> bytes:
    """A pedar export; with other times than the walk's, or some of its frames, perhaps twice."""
    rate, time = walk.recording.rate_hz, walk.recording.time if times is None else times
    head = ["sensor type:  x-1865l-1870r-pxf306-11mar2021"]
    if not how.short:
        head = ["file name: Müller.sol", *head, f"total time [secs]:  9\tscanning rate [Hz]:  {how.number(rate)}"]
        head += [f"{side} insole: {','.join(map(str, range(1, 100)))}," for side in how.sides]
    names = how.sep.join(["time[secs]", *(str(c) for _ in how.sides for c in range(1, 100))])
    table = np.hstack([_pressures(walk, side, how) for side in how.sides])
    rows = [
        how.number(time[i], how.decimals) + how.sep + how.row(table[i])
        for i in (range(len(time)) if frames is None else frames)
    ]
    return how.bytes([*head, f"pressure values in  {how.unit}", "", names, *rows])


def matrix_insoles(rows: int, columns: int, pitch: float) -> dict[Side, SoleLayout]:
    """Rounded insoles in matrices of square cells of a pitch in m."""
    down, across = np.mgrid[0:rows, 0:columns]
    round_ = ((2 * across - columns + 1) / columns) ** 2 + ((2 * down - rows + 1) / rows) ** 4 < 1.0
    return {side: grid_cells(round_, pitch, pitch, side=side, name="made", threshold=1e3) for side in SIDES}


def moticon(walk: MadeWalk, how: Writing) -> bytes:
    """A Moticon export."""
    of_foot = [*(f"pressure {i + 1}[N/cm2]" for i in range(16)), "total force[N]"]
    names = [f"{side} {name}" for side in how.sides for name in of_foot]
    out = ["# Size: 7", "# " + how.sep.join(["time", *names])]
    tables = [
        table for s in how.sides for table in (_pressures(walk, s, how), walk.recording.feet[s].vertical_force[:, None])
    ]
    table = np.hstack(tables)
    for time, row in zip(walk.recording.time / how.seconds, table, strict=True):
        out.append(how.number(time, how.decimals) + how.sep + how.row(row))
    return how.bytes(out)
