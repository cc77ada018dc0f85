"""A flexible board counted from its KiCad file alone: nets, joints, clearances, and its place in the print. In mm.

Read by text and shapely, with nothing of what drew it.
"""

import re
from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

_FRONT = "F.Cu"
_BACK = "B.Cu"
_TOUCH = 1e-4
_NUMBER = r"(-?[\d.]+)"
_SEGMENT = re.compile(
    rf"\(segment \(start {_NUMBER} {_NUMBER}\) \(end {_NUMBER} {_NUMBER}\) \(width {_NUMBER}\) "
    r'\(layer "(\S+?)"\) \(net (\d+)\)\)'
)
_VIA = re.compile(rf"\(via \(at {_NUMBER} {_NUMBER}\) \(size {_NUMBER}\) \(drill {_NUMBER}\).*?\(net (\d+)\)\)")
_EDGE = re.compile(rf'\(gr_line \(start {_NUMBER} {_NUMBER}\) \(end {_NUMBER} {_NUMBER}\) \(layer "Edge.Cuts"\)')
_FOOTPRINT = re.compile(rf'\(footprint "(\S+?)" \(layer "F.Cu"\) \(at {_NUMBER} {_NUMBER}\)')
_REFERENCE = re.compile(r'\(fp_text reference "(\S+?)"')
_COMB = re.compile(
    rf'\(pad "(\d+)" smd custom \(at {_NUMBER} {_NUMBER}\).*?\(net \d+ "(\S+?)"\).*?\(gr_poly \(pts (.*?)\) \(width'
)
_CONTACT = re.compile(
    rf'\(pad "(\d+)" smd rect \(at {_NUMBER} {_NUMBER} {_NUMBER}\) \(size {_NUMBER} {_NUMBER}\) '
    r'\(layers "F.Cu" "F.Mask"\)'
    r'(?: \(net \d+ "(\S+?)"\))?\)'
)
_POINT = re.compile(rf"\(xy {_NUMBER} {_NUMBER}\)")


@dataclass(frozen=True)
class BoardCount:
    """What a board's file holds.

    Attributes:
        taxels: Row and column net of each, by its reference.
        tail: Net of each line of the tail, "" for none.
        open_nets: Nets whose copper is not one piece with all its pads and a line of the tail.
        clearance: Least distance of copper of different nets.
        edge: Least distance of copper from the board's edge.
        hole: Least distance of a via's hole from copper of other nets.
        outline: Shapely.
    """

    taxels: dict[str, tuple[str, str]]
    tail: tuple[str, ...]
    open_nets: tuple[str, ...]
    clearance: float
    edge: float
    hole: float
    outline: Any


def count_board(text: str) -> BoardCount:
    """Gives what the text of a .kicad_pcb holds."""
    names = {int(n): name for n, name in re.findall(r'^\(net (\d+) "(\S*)"\)$', text, re.MULTILINE)}
    copper: dict[str, dict[str, list[Any]]] = {_FRONT: defaultdict(list), _BACK: defaultdict(list)}
    for x0, y0, x1, y1, width, layer, net in _SEGMENT.findall(text):
        line = shapely.LineString([(float(x0), float(y0)), (float(x1), float(y1))])
        copper[layer][names[int(net)]].append(line.buffer(0.5 * float(width)))
    holes = []
    for x, y, size, drill, net in _VIA.findall(text):
        at = shapely.Point(float(x), float(y))
        holes.append((names[int(net)], at.buffer(0.5 * float(drill))))
        for layer in copper.values():
            layer[names[int(net)]].append(at.buffer(0.5 * float(size)))
    taxels, tail, pads = _pads(text)
    for net, shape in pads:
        copper[_FRONT][net].append(shape)
    edges = [shapely.LineString([(float(a), float(b)), (float(c), float(d))]) for a, b, c, d in _EDGE.findall(text)]
    outline = max(shapely.polygonize(edges).geoms, key=lambda g: g.area)
    joined = {
        layer: {net: shapely.union_all(shapes) for net, shapes in by_net.items()} for layer, by_net in copper.items()
    }
    used = {name for name in names.values() if name}
    return BoardCount(
        taxels,
        tail,
        tuple(sorted(net for net in used if not _one_piece(net, joined, holes, pads) or tail.count(net) != 1)),
        _least_clearance(joined),
        min(float(shape.distance(outline.exterior)) for by_net in joined.values() for shape in by_net.values()),
        _least_hole(holes, joined),
        outline,
    )


def _pads(text: str) -> tuple[dict[str, tuple[str, str]], tuple[str, ...], list[tuple[str, Any]]]:
    taxels: dict[str, tuple[str, str]] = {}
    tail: dict[int, str] = {}
    pads = []
    for part in text.split('(footprint "')[1:]:
        found = _FOOTPRINT.match('(footprint "' + part)
        reference = _REFERENCE.search(part)
        assert found is not None
        assert reference is not None
        at = np.array([float(found[2]), float(found[3])])
        nets: dict[str, str] = {}
        for pin, x, y, net, points in _COMB.findall(part):
            corners = np.array([[float(v) for v in point] for point in _POINT.findall(points)])
            pads.append((net, shapely.Polygon(corners + at + np.array([float(x), float(y)]))))
            nets[pin] = nets.get(pin, "") + net
        if nets:
            taxels[reference[1]] = (nets.get("1", ""), nets.get("2", ""))
        for pin, x, y, turn, long, wide, net in _CONTACT.findall(part):
            tail[int(pin)] = net
            box = shapely.box(-0.5 * float(long), -0.5 * float(wide), 0.5 * float(long), 0.5 * float(wide))
            turned = shapely.affinity.rotate(box, -float(turn), origin=(0.0, 0.0))
            if net:
                pads.append((net, shapely.affinity.translate(turned, *(at + np.array([float(x), float(y)])))))
    return taxels, tuple(tail[k] for k in sorted(tail)), pads


def _one_piece(
    net: str, joined: dict[str, dict[str, Any]], holes: list[tuple[str, Any]], pads: list[tuple[str, Any]]
) -> bool:
    """Whether a net's copper of both layers, joined by its vias, is one piece that holds all of its pads."""
    parts = [(layer, p) for layer, by_net in joined.items() if net in by_net for p in shapely.get_parts(by_net[net])]
    owner = list(range(len(parts)))

    def root(k: int) -> int:
        while owner[k] != k:
            k = owner[k]
        return k

    for name, hole in holes:
        if name == net:
            met = [k for k, (_, part) in enumerate(parts) if part.intersects(hole)]
            for k in met[1:]:
                owner[root(k)] = root(met[0])
    roots = {root(k) for k in range(len(parts))}
    front = [part for layer, part in parts if layer == _FRONT]
    own = [shape for name, shape in pads if name == net]
    return len(roots) == 1 and all(any(part.buffer(_TOUCH).covers(shape) for part in front) for shape in own)


def _least_clearance(joined: dict[str, dict[str, Any]]) -> float:
    least = np.inf
    for by_net in joined.values():
        shapes = list(by_net.values())
        tree = shapely.STRtree(shapes)
        pairs = tree.query(shapes, predicate="dwithin", distance=1.0)
        for i, j in pairs.T.tolist():
            if i < j:
                least = min(least, float(shapes[i].distance(shapes[j])))
    return float(least)


def _least_hole(holes: list[tuple[str, Any]], joined: dict[str, dict[str, Any]]) -> float:
    least = np.inf
    for by_net in joined.values():
        names = list(by_net)
        tree = shapely.STRtree([by_net[name] for name in names])
        for net, hole in holes:
            for k in tree.query(hole, predicate="dwithin", distance=1.0).tolist():
                if names[k] != net:
                    least = min(least, float(hole.distance(by_net[names[k]])))
    return float(least)
