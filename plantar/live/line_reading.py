"""A reading as a line of text, "left,0.01,3.2,0,...": side, time in s, force of each taxel in N.

A missing force is empty or nan.
"""

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from plantar.common.sides import SIDES, Side
from plantar.errors import InputError, ReadingError
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.recordings.pressure_recording import layout_for
from plantar.sensing.reading import Reading

LONGEST = 1 << 20
"""Bytes of a line: 50,000 taxels."""


def line_of(side: Side, reading: Reading) -> bytes:
    """Returns line of a `reading` of a `side`, with its end.

    Example:
        >>> line_of("left", Reading(0.25, [1.5, math.nan]))
        b'left,0.25,1.5,nan\\n'
    """
    cells = ",".join(map(repr, reading.force.tolist()))
    return f"{side},{reading.time!r},{cells}\n".encode()


def reading_of(line: bytes, soles: Mapping[Side, SoleLayout], name: str) -> tuple[Side, Reading] | Fault:
    """Returns side and reading of a `line` for one of the `soles`; else a fault that calls it `name`."""
    text = line.decode("utf-8", "replace").strip()
    if not text:
        return Fault("blank", f"{name} holds no time and forces: it is empty; allowed: side,time,force,force,...")
    called, *cells = text.split(",")
    try:
        at, *force = _numbers(cells)
    except ValueError:
        return Fault("garbled", f"{name} holds no time and forces; allowed: side,time,force,force,...")
    side = next((known for known in soles if known == called), None)
    if side is None:
        return Fault("garbled", f"{name} begins with {called[:20]!r}; allowed: {', '.join(soles)}")
    if len(force) != len(soles[side]):
        return Fault("garbled", f"{name} holds {len(force)} forces; allowed: {len(soles[side])}, one a taxel")
    try:
        return side, Reading(at, np.array(force))  # of a list each force would be checked by itself
    except ReadingError as error:
        return Fault("impossible", f"{name}: {error}")


def _numbers(cells: list[str]) -> list[float]:
    """Numbers of cells, empty ones NaN; ValueError if one is no number."""
    try:
        return list(map(float, cells))
    except ValueError:
        return [float(cell or math.nan) for cell in cells]


def arrivals_of(chunks: Iterable[bytes], soles: Mapping[Side, SoleLayout]) -> Iterator[Arrival]:
    """Yields what each line is, of bytes as they come: an empty chunk is silence. `soles`: layouts that may come."""
    number = 0
    rest = b""
    overlong = False  # within a line whose beginning is dropped already
    for chunk in chunks:
        if not chunk:
            yield None
            continue
        *lines, rest = (rest + chunk).split(b"\n")
        for line in lines:
            number += 1
            if overlong or len(line) > LONGEST:
                yield Fault("garbled", f"line {number} is longer than {LONGEST} bytes")
                overlong = False
            else:
                yield reading_of(line, soles, f"line {number}")
        if len(rest) > LONGEST:
            overlong = True
            rest = b""
    if rest or overlong:
        yield Fault("cut", f"line {number + 1} has no end: its last number may be cut")


def soles_of(layout: SoleLayout | None, source: str) -> dict[Side, SoleLayout]:
    """Returns layouts of both sides, mirrored for the other; InputError without a `layout`, naming the `source`."""
    if layout is None:
        raise InputError(f"{source} sends forces of a sole that is not known; allowed: with --layout FILE")
    return {side: found for side in SIDES if (found := layout_for(side, layout)) is not None}
