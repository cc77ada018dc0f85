"""A shoe's wiring as files, and what is checked on them. In mm."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import shapely

from plantar.common.atomic import replacing, write_text
from plantar.shoes.build import Shoe
from plantar.shoes.checks.board_count import BoardCount, count_board
from plantar.shoes.checks.check import Check
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.wiring import hole_outline, pocket_outlines
from plantar.shoes.wiring.firmware_files import firmware_sources, header_text
from plantar.shoes.wiring.flex_board import FlexBoard, flex_board, mirrored_board
from plantar.shoes.wiring.gerber_files import gerber_zip
from plantar.shoes.wiring.grid_router import CLEARANCE, EDGE
from plantar.shoes.wiring.harness_drawing import draw_harness
from plantar.shoes.wiring.kicad_board import kicad_text
from plantar.shoes.wiring.nets import Wiring, wiring_of

_BEYOND = 0.5  # mm2 that a board may lie beyond its places by rounding


@dataclass(frozen=True)
class WiredShoe:
    """Wiring of a shoe; `board` of a sheet, `count` what its KiCad file holds, `drawing` a PNG."""

    wiring: Wiring
    board: FlexBoard | None
    board_text: str
    count: BoardCount | None
    drawing: bytes


def wire_shoe(shoe: Shoe, parameters: ShoeParameters, other: WiredShoe | None = None) -> WiredShoe | None:
    """Gives the wiring of a shoe, by parameters; None where there is none, see `wiring_of`. A sheet's board mirrors
    that of the other foot's wired shoe, if it is given.
    """
    wiring = wiring_of(shoe, parameters)
    if wiring is None:
        return None
    if wiring.circuit != "matrix":
        return WiredShoe(wiring, None, "", None, draw_harness(shoe, parameters, wiring, None))
    drawn = None if other is None else other.board
    board = flex_board(shoe, parameters) if drawn is None else mirrored_board(drawn)
    wiring = wiring_of(shoe, parameters, board.tail)
    assert wiring is not None
    text = kicad_text(board)
    return WiredShoe(wiring, board, text, count_board(text), draw_harness(shoe, parameters, wiring, board))


def write_wired(wired: WiredShoe, shoe: Shoe, folder: Path) -> list[str]:
    """Write a shoe's drawing, board and firmware into a folder; returns names."""
    side = shoe.side
    names = [f"harness_{side}.png"]
    with replacing(folder / names[0]) as path:
        path.write_bytes(wired.drawing)
    if wired.board is not None:
        names.append(write_text(folder / f"board_{side}.kicad_pcb", wired.board_text).name)
        names.append(f"gerbers_{side}.zip")
        with replacing(folder / names[-1]) as path:
            path.write_bytes(gerber_zip(wired.board))
    firmware = folder / f"firmware_{side}"
    firmware.mkdir(exist_ok=True)
    texts = {name: source.read_text(encoding="utf-8") for name, source in firmware_sources().items()}
    texts["sole.h"] = header_text(shoe, wired.wiring)
    for name, text in sorted(texts.items()):
        write_text(firmware / name, text)
        names.append(f"firmware_{side}/{name}")
    return names


def board_checks(wired: WiredShoe | None, shoe: Shoe, parameters: ShoeParameters) -> Iterator[Check]:
    """Yields checks of a sheet's board, counted from its file, against layout and print, by parameters."""
    count = None if wired is None else wired.count
    if count is None:
        return
    lines = shoe.plan.lines
    assert lines is not None
    ids = shoe.layout.ids.tolist()
    wanted = {f"T{k}": (f"R{r}", f"C{c}") for k, (r, c) in zip(ids, lines.tolist(), strict=True)}
    wrong = sum(count.taxels.get(name) != pair for name, pair in wanted.items()) + len(set(count.taxels) - set(wanted))
    yield Check("taxels of the board that are not on their row and column", wrong == 0, float(wrong), "0")
    opened = len(count.open_nets)
    yield Check("lines of the board that do not lead to the tail", opened == 0, float(opened), "0")
    yield _least("clearance of the board's copper, mm", count.clearance, CLEARANCE)
    yield _least("copper to the board's edge, mm", count.edge, EDGE)
    beyond = _beyond(count.outline, shoe, parameters)
    yield Check("board beyond its pocket and channel, mm2", beyond <= _BEYOND, round(beyond, 2), f"{_BEYOND:g} or less")


def _least(name: str, value: float, least: float) -> Check:
    return Check(name, value >= least - 1e-3, round(value, 3), f"{least:g} or more")


def _beyond(outline: Any, shoe: Shoe, p: ShoeParameters) -> float:
    """Area of a board within the plate, but not in an opening for it."""
    openings = shapely.union_all([*pocket_outlines(shoe.plan, p), hole_outline(shoe.plan, p)])
    return float((outline & shoe.plan.contact).difference(openings.buffer(1e-3)).area)
