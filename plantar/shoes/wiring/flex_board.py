"""Flexible board of a sheet: rows and columns of combs below it, and its tail. Lengths in mm, in the sole frame.

The front, which lies on the sheet and faces the ground, has of each taxel a comb of its row and one of its column. Rows
run along the front, columns zigzag on the back; both lead to the tail, whose lines are on the front.
"""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.sides import other_side
from plantar.errors import FootError
from plantar.layouts.layout import Side
from plantar.shoes.build import Shoe
from plantar.shoes.checks.printability import BOARD_UP
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.cell_room import tail_lines
from plantar.shoes.plan.shoe_plan import ShoePlan, mirrored_plan
from plantar.shoes.plan.wiring import channel_lines
from plantar.shoes.units import to_mm
from plantar.shoes.wiring.grid_router import EDGE, LINE, NEAR, STEP, VIA, GridRouter, Node

Array = NDArray[np.float64]

CONTACT = 4.0  # long, at the tail's end
TAIL_LINE = 0.25  # wide, of half the tail's pitch
SPINE = 0.3  # wide, of a comb, from which its fingers go out
FINGER = 0.4  # wide
GAP = 0.3  # between two fingers
EDGE_LINE = 0.05  # wide, along the middle of which a board is cut
_MARGIN = 0.15  # of a comb within its electrode's place
_BESIDE = 0.5  # of a row's line beyond its outermost combs
_ROOT = 2.0  # from the sheet's edge to where the grid begins
_MOUTH = 4  # steps from there to where the tail's lines begin, about the sheet's edge
_INTO = 5.0  # of the tail in its connector and beyond
_BESIDE_TAIL = 0.4  # half a pitch less than from its outermost lines to the tail's edge
_TRIES = 12  # orders of the nets
_BANDED = 6  # of these with each column's line in its own half of a gap between two rows


@dataclass(frozen=True)
class Piece:
    """A straight line of copper: net, layer (0 front, 1 back), ends (2, 2), width."""

    net: str
    layer: int
    ends: Array
    width: float


@dataclass(frozen=True)
class Comb:
    """A taxel's electrode: taxel id, net, shapely outline."""

    taxel: int
    net: str
    shape: Any


@dataclass(frozen=True)
class FlexBoard:
    """Board of one sheet.

    Attributes:
        outline: Shapely, with the tail.
        combs: Two of each taxel, row and column.
        pieces: Lines of copper.
        vias: Net and place (2,).
        tail: Nets of the tail, line by line; "" is a spare one.
        contacts: Ends (2, 2) of each line's contact at the tail's end.
    """

    side: Side
    outline: Any
    combs: tuple[Comb, ...]
    pieces: tuple[Piece, ...]
    vias: tuple[tuple[str, Array], ...]
    tail: tuple[str, ...]
    contacts: tuple[Array, ...]

    @property
    def nets(self) -> tuple[str, ...]:
        """Names of all nets."""
        return tuple(dict.fromkeys(comb.net for comb in self.combs))

    @property
    def edges(self) -> Array:
        """Ends (k, 2, 2) of the outline's edges."""
        corners = ring(self.outline)
        return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


def comb_shapes(size: float) -> tuple[Any, Any]:
    """Gives shapely combs of a row and a column about the middle of an electrode of a size, fingers between each other.

    Example:
        >>> row, column = comb_shapes(8.0)
        >>> round(row.distance(column), 3), row.geom_type
        (0.3, 'Polygon')
    """
    half = 0.5 * size - _MARGIN
    pitch = FINGER + GAP
    count = int((2.0 * half - FINGER) / pitch) + 1
    count -= 1 - count % 2  # one more of the row's than of the column's
    middles = pitch * (np.arange(count) - 0.5 * (count - 1))
    inner = half - SPINE - GAP
    of_row = [shapely.box(x - 0.5 * FINGER, -inner, x + 0.5 * FINGER, half) for x in middles[::2]]
    of_column = [shapely.box(x - 0.5 * FINGER, -half, x + 0.5 * FINGER, inner) for x in middles[1::2]]
    row = shapely.union_all([shapely.box(-half, half - SPINE, half, half), *of_row])
    column = shapely.union_all([shapely.box(-half, -half, half, SPINE - half), *of_column])
    return row, column


def flex_board(shoe: Shoe, parameters: ShoeParameters) -> FlexBoard:
    """Gives the routed board of a shoe with a sheet, by parameters.

    The boards of a pair are mirror images. FootError where a line finds no way to the tail.
    """
    # Both hands are tried, whichever is asked for: combs and tail are not symmetric, so that lines may find their ways
    # on a sheet but not on its mirror image.
    other = mirrored_plan(shoe.plan)
    plans = (shoe.plan, other) if shoe.side == "left" else (other, shoe.plan)
    drawings = [_Drawing(plan, parameters) for plan in plans]
    orders = [sorted(drawing.names, key=lambda name: abs(drawing.levels[name])) for drawing in drawings]  # inner first
    for attempt in range(_TRIES):
        for drawing, order in zip(drawings, orders, strict=True):
            failed = drawing.routed(order, banded=attempt < _BANDED)
            if failed is None:
                board = drawing.board()
                return board if board.side == shoe.side else mirrored_board(board)
            order.remove(failed)
            order.insert(0, failed)
    raise FootError(
        f"no way for line {orders[0][0]} of the sheet to its tail; use a larger pitch or narrower electrodes"
    )


def mirrored_board(board: FlexBoard) -> FlexBoard:
    """Board of the other foot's shoe: y changes sign.

    The tail's lines are counted from the other edge: those of the adapter are, as they lie on it.
    """
    flip = np.array([1.0, -1.0])

    def flipped(shape: Any) -> Any:
        return shapely.geometry.polygon.orient(shapely.Polygon(ring(shape) * flip))

    return FlexBoard(
        other_side(board.side),
        flipped(board.outline),
        tuple(replace(comb, shape=flipped(comb.shape)) for comb in board.combs),
        tuple(replace(piece, ends=piece.ends * flip) for piece in board.pieces),
        tuple((net, place * flip) for net, place in board.vias),
        board.tail[::-1],
        tuple(ends * flip for ends in reversed(board.contacts)),
    )


class _Part(NamedTuple):
    """A joined part of a net's copper on a layer, known by its shapely middle lines."""

    layer: int
    middle: Any


class _Drawing:
    def __init__(self, plan: ShoePlan, p: ShoeParameters) -> None:
        assert plan.cell is not None
        assert plan.lines is not None
        assert plan.crossings is not None
        self.side = plan.side
        self.ids = plan.layout.ids.tolist()
        self.at: Array = plan.crossings
        self.taxel_lines: NDArray[np.int64] = plan.lines
        self.size = plan.cell.line_width
        self.half = 0.5 * self.size - _MARGIN
        self.pitch = plan.cell.pitch_x
        self.names = [f"R{r}" for r in range(plan.sheet_lines[0])] + [f"C{c}" for c in range(plan.sheet_lines[1])]
        self.numbers = {name: n for n, name in enumerate(self.names, start=1)}
        self._lay_out(plan, p)
        self._plan_tail()

    def _lay_out(self, plan: ShoePlan, p: ShoeParameters) -> None:
        """Outline, tail, and grid in the tail's directions."""
        assert plan.cell is not None
        sheet = plan.pockets[0].buffer(-max(plan.cell.play, p.made_by.slide), join_style="mitre")
        sheet = max(getattr(sheet, "geoms", [sheet]), key=lambda g: g.area)
        line = channel_lines(plan, p)[0]
        start, turn, end = line
        self.out = (end - turn) / np.hypot(*(end - turn))
        self.across = np.array([-self.out[1], self.out[0]])
        self.count = tail_lines(plan)
        pitch = plan.cell.tail_pitch
        if pitch != STEP:
            raise FootError(f"cell {plan.cell.label}: tail_pitch is {pitch:g} mm; the adapter's is {STEP:g} mm")
        far = float(np.ptp(to_mm(plan.layout.outline[:, 0])))
        ray = shapely.LineString([turn - far * self.out, turn + far * self.out])
        leaves = shapely.get_coordinates(sheet.intersection(ray))
        self.root = turn + self.out * (float(((leaves - turn) @ self.out).max()) + _ROOT)
        rise = p.thickness - p.ceiling + BOARD_UP if plan.heel.board else 0.0
        length = float((end - self.root) @ self.out) + rise + _INTO
        half = 0.5 * self.count * pitch + _BESIDE_TAIL
        inward = float((self.root - start) @ self.out)
        corners = [(-inward, -half), (length, -half), (length, half), (-inward, half)]
        tail = shapely.Polygon([self.root + u * self.out + v * self.across for u, v in corners])
        self.outline = shapely.geometry.polygon.orient(shapely.union_all([sheet, tail], grid_size=1e-4))
        if self.outline.interiors:
            self.outline = shapely.Polygon(self.outline.exterior)
        self.length = length
        corners_of = ring(self.outline) - self.root
        inside = -float((corners_of @ self.out).min())
        beside = float(np.abs(corners_of @ self.across).max())
        half_count = int(np.ceil(beside / STEP)) + 1
        # a tail of an even number of lines has none in its middle
        shift = 0.5 * STEP * ((self.count - 1) % 2)
        origin = self.root - (half_count * STEP + shift) * self.across
        self.first_pin = half_count + round(shift / STEP - 0.5 * (self.count - 1))
        shape = (int(np.ceil(inside / STEP)) + 2, 2 * half_count + 2)
        self.grid = (origin, -self.out, self.across, shape)

    def _plan_tail(self) -> None:
        """Each net's line of the tail, in the order across it in which rows end and columns leave between them.

        Rows end where they lie; of each gap between two rows two columns leave, each in its half, so that no line has
        to pass another on its way to the tail.
        """
        level = (self.at - self.root) @ self.across
        rows = self.taxel_lines[:, 0]
        columns = self.taxel_lines[:, 1]
        middle = {r: float(level[rows == r].mean()) for r in np.unique(rows).tolist()}
        ordered = sorted(middle, key=lambda r: middle[r])
        gaps = [(low, high, 0.5 * (middle[low] + middle[high])) for low, high in pairwise(ordered)]
        self.levels = {f"R{r}": at for r, at in middle.items()}
        self.bands: dict[str, tuple[float, float]] = {}
        used = dict.fromkeys(range(len(gaps)), 0)
        far = -((self.at - self.root) @ self.out)
        for c in sorted(np.unique(columns).tolist(), key=lambda c: float(far[columns == c].mean())):
            own = set(rows[columns == c].tolist())
            open_ = [g for g, (low, high, _) in enumerate(gaps) if low in own and high in own and used[g] < 2]
            if not open_:
                self.levels[f"C{c}"] = float(level[columns == c].mean())
                continue
            gap = min(open_, key=lambda g: (used[g], abs(gaps[g][2])))
            low, high, at = gaps[gap]
            half = 0.5 * (middle[high] - middle[low]) - self.half
            side = (1.0 if at >= 0.0 else -1.0) * (1.0 if used[gap] else -1.0)
            used[gap] += 1
            ends = sorted((at, at + side * half))
            self.bands[f"C{c}"] = (ends[0], ends[1])
            self.levels[f"C{c}"] = at + 0.5 * side * half
        across = sorted(self.names, key=lambda name: self.levels[name])
        self.pin_of = {name: k for k, name in enumerate(across)}

    def routed(self, order: list[str], banded: bool = True) -> str | None:
        """Draw all; the first net that finds no way, else None."""
        self.banded = banded
        region = self.outline.buffer(-EDGE - 0.5 * LINE)
        self.router = GridRouter(*self.grid, region)
        self.pieces: list[Piece] = []
        self.vias: list[tuple[str, Array]] = []
        self.pins: dict[int, str] = {}
        self.parts: dict[str, list[_Part]] = {name: [] for name in self.names}
        combs = shapely.box(-self.half, -self.half, self.half, self.half)
        for x, y in self.at.tolist():
            self.router.block(shapely.affinity.translate(combs, x, y), 0)
        for name, pin in self.pin_of.items():
            start = self.router.point(Node(0, _MOUTH, self.first_pin + pin))
            end = start + (_MOUTH * STEP + self.length - EDGE - 0.5 * TAIL_LINE) * self.out
            self._piece(name, 0, np.stack([start, end]), TAIL_LINE)
        for name in self.names:
            self._draw_line(name)
        for name in order:
            if not self._lead_out(name):
                return name
        return None

    def _draw_line(self, name: str) -> None:
        """A row along its combs, or a column from via to via, in as many parts as the sheet's outline leaves."""
        axis = 0 if name[0] == "R" else 1
        on = self.at[self.taxel_lines[:, axis] == int(name[1:])]
        on = on[np.argsort(on[:, axis], kind="stable")]
        if axis == 0:
            self._draw_row(name, on)
        else:
            self._draw_column(name, on)

    def _draw_row(self, name: str, on: Array) -> None:
        level = self.half - 0.5 * SPINE
        beyond = np.where(self.out[0] < 0.0, [-_BESIDE, 0.0], [0.0, _BESIDE])  # at the tail's end
        for run in np.split(on, np.flatnonzero(np.diff(on[:, 0]) > 1.5 * self.pitch) + 1):
            x = np.array([run[0, 0] - self.half, run[-1, 0] + self.half]) + beyond
            ends = np.column_stack([x, run[[0, -1], 1] + level])
            self._part(name, 0, [ends])

    def _draw_column(self, name: str, on: Array) -> None:
        places = on + np.array([0.0, 0.5 * SPINE - self.half])
        for place in places:
            self._via(name, place)
        inside = np.array(
            [self.router.region.covers(shapely.LineString(ends)) for ends in pairwise(places)], dtype=bool
        )
        for run in np.split(places, np.flatnonzero(~inside) + 1):
            alone = [run.repeat(2, axis=0)]
            self._part(name, 1, [np.stack(ends) for ends in pairwise(run)] or alone)

    def _part(self, name: str, layer: int, lines: list[Array]) -> None:
        """Draw a part of a net's copper by its middle lines."""
        for ends in lines:
            self._piece(name, layer, ends)
        middle = shapely.union_all([shapely.LineString(ends) for ends in lines])
        self.parts[name].append(_Part(layer, middle))

    def _piece(self, name: str, layer: int, ends: Array, width: float = LINE) -> None:
        if np.hypot(*(ends[1] - ends[0])) < 1e-9:
            return
        self.pieces.append(Piece(name, layer, ends, width))
        shape = shapely.LineString(ends).buffer(0.5 * width)
        self.router.occupy(shape, layer, self.numbers[name])

    def _via(self, name: str, place: Array) -> None:
        self.vias.append((name, place))
        for layer in (0, 1):
            self.router.occupy(shapely.Point(place).buffer(0.5 * VIA), layer, self.numbers[name])

    def _sources(self, name: str, part: _Part) -> list[Node]:
        found = self.router.within(part.middle.buffer(NEAR - 1e-3), part.layer, self.numbers[name])
        band = self.bands.get(name)
        if not self.banded or band is None:
            return found
        low, high = band
        levels = [float((self.router.point(node) - self.root) @ self.across) for node in found]
        return [node for node, level in zip(found, levels, strict=True) if low <= level <= high] or found

    def _lead_out(self, name: str) -> bool:
        """Join a net's parts, and lead it to a free line of the tail."""
        parts = self.parts[name]
        number = self.numbers[name]
        joined = [parts[0]]
        left = parts[1:]
        while left:
            targets = {node: part for part in left for node in self._sources(name, part)}
            way = self.router.route(number, [n for q in joined for n in self._sources(name, q)], list(targets))
            if way is None:
                return False
            reached = targets[way[-1]]
            self._take(name, way, joined, [reached])
            joined.append(reached)
            left = [part for part in left if part is not reached]
        aim = Node(0, _MOUTH, self.first_pin + self.pin_of[name])
        way = self.router.route(number, [n for q in joined for n in self._sources(name, q)], [aim])
        if way is None:
            return False
        self._take(name, way, joined, [])
        self.pins[self.pin_of[name]] = name
        return True

    def _take(self, name: str, way: list[Node], joined: list[_Part], reached: list[_Part]) -> None:
        """Draw a way: from the copper of a joined part, with vias, to that of a reached one, or of none."""
        places = [self.router.point(node) for node in way]
        for node, place, parts in ((way[0], places[0], joined), (way[-1], places[-1], reached)):
            near = [part.middle for part in parts if part.layer == node.layer]
            if near:
                middle = min(near, key=lambda m: float(m.distance(shapely.Point(place))))
                touch = np.array(shapely.shortest_line(middle, shapely.Point(place)).coords)
                self._piece(name, node.layer, touch)
        start = 0
        for k in range(1, len(way)):
            if way[k].layer != way[k - 1].layer:
                self._straight(name, way[start:k], places[start:k])
                self._via(name, places[k])
                start = k
        self._straight(name, way[start:], places[start:])

    def _straight(self, name: str, way: list[Node], places: list[Array]) -> None:
        corner = 0
        for k in range(1, len(way)):
            last = k == len(way) - 1
            turns = not last and (way[k + 1].i - way[k].i, way[k + 1].j - way[k].j) != (
                way[k].i - way[k - 1].i,
                way[k].j - way[k - 1].j,
            )
            if turns or last:
                self._piece(name, way[k].layer, np.stack([places[corner], places[k]]))
                corner = k

    def board(self) -> FlexBoard:
        row, column = comb_shapes(self.size)
        combs = []
        for taxel, (x, y), (r, c) in zip(self.ids, self.at.tolist(), self.taxel_lines.tolist(), strict=True):
            combs.append(Comb(taxel, f"R{r}", shapely.affinity.translate(row, x, y)))
            combs.append(Comb(taxel, f"C{c}", shapely.affinity.translate(column, x, y)))
        contacts = []
        for k in range(self.count):
            at = self.root + STEP * (k - 0.5 * (self.count - 1)) * self.across
            ends = [self.length - EDGE - CONTACT, self.length - EDGE]
            contacts.append(np.stack([at + u * self.out for u in ends]))
        tail = tuple(self.pins.get(k, "") for k in range(self.count))
        return FlexBoard(
            self.side, self.outline, tuple(combs), tuple(self.pieces), tuple(self.vias), tail, tuple(contacts)
        )
