"""Gerbers (RS-274X) and holes (Excellon) of a flexible board. In mm, seen from the front, where y points up."""

import zipfile
from collections.abc import Iterable, Iterator
from io import BytesIO
from typing import Any

import numpy as np

from plantar.shoes.geometry.outline import ring
from plantar.shoes.wiring.flex_board import EDGE_LINE, TAIL_LINE, FlexBoard
from plantar.shoes.wiring.grid_router import HOLE, VIA

_UNIT = 1e6  # counts of a file to a mm: four digits before the point and six behind


def gerber_zip(board: FlexBoard) -> bytes:
    """Gives an archive of a board's front, back, masks, outline and holes, as makers of boards take it."""
    contacts = [(ends, TAIL_LINE) for ends in board.contacts]
    edges = [(ends, EDGE_LINE) for ends in board.edges]
    combs = [comb.shape for comb in board.combs]
    lines = [[(q.ends, q.width) for q in board.pieces if q.layer == layer] for layer in (0, 1)]
    vias = [place for _, place in board.vias]
    files = {
        "front_copper.gtl": _gerber("Copper,L1,Top", combs, [*contacts, *lines[0]], vias),
        "back_copper.gbl": _gerber("Copper,L2,Bot", [], lines[1], vias),
        "front_mask.gts": _gerber("Soldermask,Top", combs, contacts, []),
        "back_mask.gbs": _gerber("Soldermask,Bot", [], [], []),
        "outline.gko": _gerber("Profile,NP", [], edges, []),
        "holes.drl": _holes(vias),
    }
    out = BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))  # equal boards are equal files
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, text)
    return out.getvalue()


def _at(place: Any) -> str:
    x, y = np.asarray(place).tolist()
    return f"X{round(x * _UNIT)}Y{round(-y * _UNIT)}"


def _gerber(function: str, shapes: Iterable[Any], lines: Iterable[tuple[Any, float]], flashes: Iterable[Any]) -> str:
    """Filled outlines, lines of widths between two ends, and pads of vias."""
    drawn = list(lines)
    codes = {width: code for code, width in enumerate(dict.fromkeys([VIA, *(w for _, w in drawn)]), start=10)}
    body = [
        f"%TF.FileFunction,{function}*%",
        "%FSLAX46Y46*%",
        "%MOMM*%",
        *(f"%ADD{code}C,{width:.4f}*%" for width, code in codes.items()),
        "%LPD*%",
        "G01*",
    ]
    for shape in shapes:
        body += _region(shape)
    for width, code in codes.items():
        own = [ends for ends, wide in drawn if wide == width]
        if own:
            body.append(f"D{code}*")
        for start, end in own:
            body += [f"{_at(start)}D02*", f"{_at(end)}D01*"]
    pads = [f"{_at(place)}D03*" for place in flashes]
    if pads:
        body += [f"D{codes[VIA]}*", *pads]
    return "\n".join([*body, "M02*", ""])


def _region(shape: Any) -> Iterator[str]:
    first, *others = ring(shape)
    yield "G36*"
    yield f"{_at(first)}D02*"
    for corner in (*others, first):
        yield f"{_at(corner)}D01*"
    yield "G37*"


def _holes(places: Iterable[Any]) -> str:
    lines = [f"X{x:.4f}Y{-y:.4f}" for x, y in np.asarray(list(places)).reshape(-1, 2).tolist()]
    return "\n".join(["M48", "FMAT,2", "METRIC", f"T1C{HOLE:.4f}", "%", "G90", "T1", *lines, "M30", ""])
