"""Feet that break shoe makers: split, padded, pitched soles, round heels, plates, toes of two parts, double, small."""

from collections.abc import Callable, Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Triangles = NDArray[np.float64]

TURNS = 50
"""Small rotations that each foot is tried in."""

REFUSED = frozenset({"pair", "ball", "lying"})
"""Feet that no shoe can be made for."""


def prism(outline: NDArray[np.float64], low: float, high: float) -> Triangles:
    """Closed surface (n, 3, 3) of a simple outline (k, 2) between two heights."""
    import shapely

    polygon = shapely.geometry.polygon.orient(shapely.Polygon(outline))
    flat = np.array(
        [
            np.array(shapely.geometry.polygon.orient(t).exterior.coords)[:3]
            for t in shapely.constrained_delaunay_triangles(polygon).geoms
        ]
    )
    ring = np.array(polygon.exterior.coords)
    walls = []
    for a, b in pairwise(ring):
        walls += [[[*a, low], [*b, low], [*b, high]], [[*a, low], [*b, high], [*a, high]]]
    return np.concatenate([_at(flat, low)[:, ::-1], _at(flat, high), np.array(walls)])


def _at(flat: Triangles, z: float) -> Triangles:
    return np.concatenate([flat, np.full((*flat.shape[:-1], 1), z)], axis=-1)


def box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Triangles:
    """Closed surface of a box from its extents."""
    return prism(np.array([[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]), *z)


def _disc(x: float, y: float, radius: float, low: float, high: float, count: int = 24) -> Triangles:
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return prism(np.array([x, y]) + radius * np.column_stack([np.cos(angle), np.sin(angle)]), low, high)


def oval(length: float, width: float, x: float, count: int = 72, power: float = 3.0) -> NDArray[np.float64]:
    """A superellipse (count, 2) about a place on x."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    c, s = np.cos(angle), np.sin(angle)
    k = 2.0 / power
    return np.column_stack([x + 0.5 * length * np.sign(c) * abs(c) ** k, 0.5 * width * np.sign(s) * abs(s) ** k])


def _joint(high: float = 70.0) -> Triangles:
    return np.concatenate([box((-22.0, 22.0), (-24.0, 24.0), (15.0, high)), _disc(0.0, 0.0, 30.0, 20.0, high - 8.0)])


def _split() -> Triangles:
    parts = [box((-90.0, -25.0), (-42.0, 42.0), (0.0, 18.0)), box((35.0, 140.0), (-48.0, 48.0), (0.0, 18.0))]
    return np.concatenate([*parts, box((-90.0, 140.0), (-40.0, 40.0), (12.0, 30.0)), _joint()])


def _pads() -> Triangles:
    spots = [(-70.0, -35.0), (-70.0, 35.0), (115.0, -38.0), (115.0, 38.0), (30.0, 0.0)]
    pads = [_disc(x, y, 13.0, 0.0, 8.0) for x, y in spots]
    return np.concatenate([*pads, box((-90.0, 135.0), (-52.0, 52.0), (7.0, 22.0)), _joint()])


def _pitched() -> Triangles:
    x = np.linspace(-80.0, 150.0, 24)
    rise = 0.14 * np.maximum(0.0, x - 80.0) + 0.08 * np.maximum(0.0, -50.0 - x)
    parts = []
    for (a, za), (b, zb) in pairwise(zip(x, rise, strict=True)):
        low, high = np.array([[a, za], [b, zb]]), 34.0
        corners = [(a, -45.0, low[0, 1]), (b, -45.0, low[1, 1]), (b, 45.0, low[1, 1]), (a, 45.0, low[0, 1])]
        top = [(x, y, high) for x, y, _ in corners]
        quads = [corners[::-1], top] + [[corners[i], corners[(i + 1) % 4], top[(i + 1) % 4], top[i]] for i in range(4)]
        parts += [np.array([[q[0], q[1], q[2]], [q[0], q[2], q[3]]]) for q in quads]
    return np.concatenate([*parts, _joint(95.0)])


def _backwards() -> Triangles:
    return (_toe_out() * np.array([-1.0, -1.0, 1.0])).copy()


def _toe_out() -> Triangles:
    outline = np.array([[-75, -36], [60, -50], [130, -12], [138, 26], [118, 54], [40, 60], [-72, 34]], dtype=float)
    return np.concatenate([prism(outline, 0.0, 28.0), _joint()])


def _pair() -> Triangles:
    left = _toe_out() + np.array([0.0, 110.0, 0.0])
    right = (_toe_out() * np.array([1.0, -1.0, 1.0]))[:, ::-1] - np.array([0.0, 110.0, 0.0])
    return np.concatenate([left, right])


def _turned_30() -> Triangles:
    return turned(np.concatenate([prism(oval(230.0, 95.0, 35.0), 0.0, 30.0), _joint()]), 0.0, 0.0, 30.0)


def _small() -> Triangles:
    return np.concatenate([box((-26.0, 54.0), (-25.0, 25.0), (0.0, 14.0)), box((-8, 8), (-9, 9), (10.0, 30.0))])


def _large() -> Triangles:
    sole = prism(oval(420.0, 170.0, 70.0, 96, 4.0), 0.0, 40.0)
    return np.concatenate([sole, box((-50.0, 50.0), (-50.0, 50.0), (35.0, 130.0))])


def _concave() -> Triangles:
    """Two toes and two heels of pads below, one deeply waisted plate above."""
    outline = oval(240.0, 104.0, 25.0, 96, 2.8)
    squeeze = 1.0 - 0.5 * np.exp(-(((outline[:, 0] - 25.0) / 34.0) ** 2))
    plate = outline * np.column_stack([np.ones(len(outline)), squeeze])
    low = [box((-85.0, -45.0), (y, y + 24.0), (0.0, 5.0)) for y in (-36.0, 12.0)]
    low += [box((75.0, 130.0), (y, y + 28.0), (0.0, 5.0)) for y in (-42.0, 14.0)]
    return np.concatenate([*low, prism(plate, 3.0, 40.0), _joint(90.0)])


def loft(outlines: Iterable[NDArray[np.float64]], heights: Iterable[float]) -> Triangles:
    """Closed surface of star-shaped outlines (k, 2) of as many points at rising heights."""
    rings = [np.column_stack([o, np.full(len(o), z)]) for o, z in zip(outlines, heights, strict=True)]
    parts = []
    for low, high in pairwise(rings):
        after, up = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
        parts += [np.stack([low, after, up], axis=1), np.stack([low, up, high], axis=1)]
    for ring, above in ((rings[0], False), (rings[-1], True)):
        fan = np.stack([np.broadcast_to(ring.mean(axis=0), ring.shape), ring, np.roll(ring, -1, axis=0)], axis=1)
        parts.append(fan if above else fan[:, ::-1])
    return np.concatenate(parts)


def rounded(count: int = 320, levels: int = 40) -> Triangles:
    """Rounded foot whose surface is cut into about 4 count levels triangles."""
    inset = 12.0 * (1.0 - np.sin(np.linspace(0.0, np.pi / 2, levels)))
    below = np.linspace(0.0, 1.0, levels) ** 2 * 12.0
    outlines = [oval(230 - 2 * d, 100 - 2 * d, 25.0, count) for d in (*inset, *np.zeros(levels))]
    return loft(outlines, [*below, *np.linspace(13.0, 45.0, levels)])


def _tilted() -> Triangles:
    return turned(_toe_out(), 9.0, -14.0, 0.0)


def _stadium(heel: float, length: float, toes: float) -> NDArray[np.float64]:
    """An outline with round ends of two radii, the ankle a third from the heel."""
    angle = np.linspace(0.5 * np.pi, 1.5 * np.pi, 33)
    back = np.column_stack([heel + heel * np.cos(angle), heel * np.sin(angle)])
    front = np.column_stack([length - toes - toes * np.cos(angle), -toes * np.sin(angle)])
    return np.vstack([back, front]) - np.array([0.36 * length, 0.0])


def _round_heel(heel: float, length: float, toes: float) -> Triangles:
    return np.concatenate([prism(_stadium(heel, length, toes), 0.0, 30.0), _joint()])


def _two_toes() -> Triangles:
    toes = [box((70.0, 140.0), y, (0.0, 20.0)) for y in ((-48.0, -3.0), (3.0, 48.0))]
    return np.concatenate([box((-90.0, 70.0), (-48.0, 48.0), (0.0, 24.0)), *toes, _joint()])


def _toe_joint() -> Triangles:
    toes = box((92.0, 150.0), (-48.0, 48.0), (0.0, 18.0))
    return np.concatenate([box((-90.0, 88.0), (-48.0, 48.0), (0.0, 24.0)), toes, _joint()])


def _of_65_mm() -> Triangles:
    return np.concatenate([box((-22.0, 43.0), (-20.0, 20.0), (0.0, 12.0)), box((-7, 7), (-8, 8), (10.0, 28.0))])


def _ball(radius: float = 60.0, count: int = 24) -> Triangles:
    up, around = np.meshgrid(np.linspace(0, np.pi, count), np.linspace(0, 2 * np.pi, 2 * count), indexing="ij")
    p = radius * np.stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), np.cos(up)], axis=-1)
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    return np.concatenate([np.stack(t, axis=-2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])


FAMILY: dict[str, Callable[[], Triangles]] = {
    "split": _split,
    "pads": _pads,
    "pitched": _pitched,
    "toe_out": _toe_out,
    "backwards": _backwards,
    "pair": _pair,
    "turned_30": _turned_30,
    "small": _small,
    "large": _large,
    "concave": _concave,
    "fine": rounded,
    "tilted": _tilted,
    "round_heel": lambda: _round_heel(45.0, 240.0, 45.0),
    "narrow_heel": lambda: _round_heel(30.0, 200.0, 45.0),
    "narrow_toes": lambda: _round_heel(50.0, 240.0, 24.0),
    "two_toes": _two_toes,
    "toe_joint": _toe_joint,
    "of_65_mm": _of_65_mm,
    "plate": lambda: prism(oval(240.0, 90.0, 30.0), 0.0, 2.0),
    "ball": _ball,
    "lying": lambda: box((-60.0, 140.0), (-10.0, 10.0), (0.0, 120.0)),
}
"""Surfaces in mm, x to the toes, y left, z up, the ankle above the origin, by what is hard about them."""


def turned(triangles: Triangles, roll: float, pitch: float, yaw: float) -> Triangles:
    """A surface turned about x, then y, then z by angles in degrees."""
    out = triangles
    for axis, angle in enumerate(np.radians([roll, pitch, yaw])):
        c, s = np.cos(angle), np.sin(angle)
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        turn = np.eye(3)
        turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
        out = out @ turn.T
    return np.asarray(out)


def small_turns(name: str) -> NDArray[np.float64]:
    """Roll, pitch and yaw (TURNS, 3) in degrees that a foot is tried in; the first is none."""
    chance = np.random.default_rng(sum(map(ord, name)))
    return np.vstack([np.zeros(3), chance.uniform([-0.8, -0.8, -3.0], [0.8, 0.8, 3.0], (TURNS - 1, 3))])
