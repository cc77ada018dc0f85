"""A flexible board as KiCad's file (version 6 and later). In mm; KiCad's y points down, as y seen from the ground."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from plantar.shoes.geometry.outline import ring
from plantar.shoes.wiring.flex_board import CONTACT, EDGE_LINE, SPINE, TAIL_LINE, FlexBoard
from plantar.shoes.wiring.grid_router import HOLE, VIA

_VERSION = 20211014  # of the file format, which KiCad 6 introduced
_THICK = 0.2
_LAYERS = (
    '(0 "F.Cu" signal) (31 "B.Cu" signal) (36 "B.SilkS" user) (37 "F.SilkS" user) (38 "B.Mask" user) '
    '(39 "F.Mask" user) (44 "Edge.Cuts" user) (46 "B.CrtYd" user) (47 "F.CrtYd" user)'
)
_FONT = "(effects (font (size 1 1) (thickness 0.15)))"
_COPPER = ("F.Cu", "B.Cu")


def kicad_text(board: FlexBoard) -> str:
    """Gives a board as the text of a .kicad_pcb: front towards the ground, as the file shows it."""
    number = {name: n for n, name in enumerate(board.nets, start=1)}
    lines = [
        f"(kicad_pcb (version {_VERSION}) (generator plantar)",
        f'(general (thickness {_THICK})) (paper "A2") (layers {_LAYERS})',
        "(setup (pad_to_mask_clearance 0))",
        '(net 0 "")',
        *(f'(net {n} "{name}")' for name, n in number.items()),
        *_outline(board),
        *_taxels(board, number),
        *_connector(board, number),
    ]
    for piece in board.pieces:
        (x0, y0), (x1, y1) = piece.ends.tolist()
        lines.append(
            f"(segment (start {x0:.4f} {y0:.4f}) (end {x1:.4f} {y1:.4f}) (width {piece.width:g}) "
            f'(layer "{_COPPER[piece.layer]}") (net {number[piece.net]}))'
        )
    for net, (x, y) in board.vias:
        lines.append(
            f'(via (at {x:.4f} {y:.4f}) (size {VIA:g}) (drill {HOLE:g}) (layers "F.Cu" "B.Cu") (net {number[net]}))'
        )
    return "\n".join([*lines, ")", ""])


def _outline(board: FlexBoard) -> Iterator[str]:
    for (x0, y0), (x1, y1) in board.edges.tolist():
        yield f'(gr_line (start {x0:.4f} {y0:.4f}) (end {x1:.4f} {y1:.4f}) (layer "Edge.Cuts") (width {EDGE_LINE:g}))'


def _taxels(board: FlexBoard, number: dict[str, int]) -> Iterator[str]:
    for row, column in zip(board.combs[::2], board.combs[1::2], strict=True):
        x, y = row.shape.union(column.shape).envelope.centroid.coords[0]
        yield f'(footprint "plantar:taxel" (layer "F.Cu") (at {x:.4f} {y:.4f}) (attr smd)'
        yield f'(fp_text reference "T{row.taxel}" (at 0 0) (layer "F.SilkS") hide {_FONT})'
        for pin, comb in (("1", row), ("2", column)):
            yield _comb_pad(pin, ring(comb.shape) - (x, y), comb.net, number)
        yield ")"


def _comb_pad(pin: str, corners: NDArray[np.float64], net: str, number: dict[str, int]) -> str:
    """A pad of any outline: a small anchor in its spine, and the outline about it."""
    spine = corners[np.argmax(np.abs(corners[:, 1]))]
    anchor = np.array([0.0, spine[1] - 0.5 * SPINE * np.sign(spine[1])])
    points = " ".join(f"(xy {x:.4f} {y:.4f})" for x, y in (corners - anchor).tolist())
    return (
        f'(pad "{pin}" smd custom (at {anchor[0]:.4f} {anchor[1]:.4f}) (size 0.2 0.2) (layers "F.Cu" "F.Mask") '
        f'(net {number[net]} "{net}") (options (clearance outline) (anchor rect)) '
        f"(primitives (gr_poly (pts {points}) (width 0) (fill yes))))"
    )


def _connector(board: FlexBoard, number: dict[str, int]) -> Iterator[str]:
    middles = [ends.mean(axis=0) for ends in board.contacts]
    x, y = np.mean(middles, axis=0).tolist()
    way = board.contacts[0][1] - board.contacts[0][0]
    turn = float(np.degrees(np.arctan2(-way[1], way[0])))
    yield f'(footprint "plantar:tail" (layer "F.Cu") (at {x:.4f} {y:.4f}) (attr smd)'
    yield f'(fp_text reference "J1" (at 0 0) (layer "F.SilkS") hide {_FONT})'
    for pin, (at, net) in enumerate(zip(middles, board.tail, strict=True), start=1):
        named = f' (net {number[net]} "{net}")' if net else ""
        yield (
            f'(pad "{pin}" smd rect (at {at[0] - x:.4f} {at[1] - y:.4f} {turn:.4f}) (size {CONTACT:g} {TAIL_LINE:g}) '
            f'(layers "F.Cu" "F.Mask"){named})'
        )
    yield ")"
