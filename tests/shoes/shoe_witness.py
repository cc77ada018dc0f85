"""An independent witness of a shoe: rays and distances on the exported STL, the foot's own mesh and the layout file.

Nothing here is built on the code that makes the shoe: rays meet triangles by Moeller and Trumbore's test, the figures
come from `check.json`'s parameters and the layout file, as a buyer of the shoe has them.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
import trimesh
from numpy.typing import NDArray
from scipy.ndimage import label

Array = NDArray[np.float64]


def hits(triangles: Array, start: Array, direction: Array) -> Array:
    """Sorted distances along a ray at which it meets triangles (n, 3, 3)."""
    a, u, v = triangles[:, 0], triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    across = np.cross(direction, v)
    volume = np.einsum("ij,ij->i", u, across)
    with np.errstate(divide="ignore", invalid="ignore"):
        offset = start - a
        p = np.einsum("ij,ij->i", offset, across) / volume
        other = np.cross(offset, u)
        q = other @ direction / volume
        way = np.einsum("ij,ij->i", v, other) / volume
        met = (np.abs(volume) > 1e-12) & (p >= 0.0) & (q >= 0.0) & (p + q <= 1.0) & (way > 1e-9)
    return np.asarray(np.unique(way[met].round(5)))


def _even(segments: Array, x: float, ys: Array) -> NDArray[np.bool_]:
    """Whether each point (x, y) lies outside of what segments (n, 2, 2) enclose: an even number of them is above it."""
    (ax, ay), (bx, by) = segments[:, 0].T, segments[:, 1].T
    across = (ax > x) != (bx > x)
    at = ay[across] + (x - ax[across]) / (bx[across] - ax[across]) * (by[across] - ay[across])
    return np.asarray((at[None] > ys[:, None]).sum(axis=1) % 2 == 0)


def _modulus(hardness: float, area: float, around: float, thick: float) -> float:
    """Of a rubber layer that does not slide, MPa: Gent's of the hardness, and Gent and Lindley's of the shape."""
    free = 0.0981 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))
    k = float(np.interp(hardness, (30, 40, 50, 60, 70), (0.93, 0.85, 0.73, 0.57, 0.53)))
    return free * (1.0 + 2.0 * k * (area / (around * thick)) ** 2)


def _share(at: Array, k: Array, gap: Array, taxel: NDArray[np.bool_], force: float) -> float:
    """Share of a force in the points' middle that the taxels' springs carry, by scipy's root of the balance."""
    from scipy.optimize import least_squares

    u = np.column_stack([np.ones(len(at)), (at - at.mean(axis=0)) / 100.0])
    wanted = np.array([force, 0.0, 0.0])
    start = np.array([force / k[taxel].sum(), 0.0, 0.0])

    def off(place: Array) -> Array:
        return np.asarray((u.T @ (k * np.maximum(u @ place - gap, 0.0)) - wanted) / force)

    place = least_squares(off, start, x_scale=np.maximum(abs(start[0]), 1e-3), xtol=1e-12, ftol=1e-12, gtol=1e-12).x
    assert np.abs(off(place)).max() < 1e-4
    way = k * np.maximum(u @ place - gap, 0.0)
    return float(way[taxel].sum() / way.sum())


@dataclass
class Witness:
    """The files of a left shoe in a folder, and the foot in its sole frame.

    Attributes:
        folder: Where `plantar shoe` wrote.
        foot: Triangles (n, 3, 3) of the foot in mm, its sole at z = 0.
    """

    folder: Path
    foot: Array

    def __post_init__(self) -> None:
        told = json.loads((self.folder / "check.json").read_text())
        self.kind: str = told["kind"]
        self.mesh: Any = trimesh.load(self.folder / f"{self.kind}_left.stl", force="mesh")
        self.pad: Any = trimesh.load(self.folder / "pad_left.stl", force="mesh")
        self.triangles = np.asarray(self.mesh.triangles)
        self.layout = json.loads((self.folder / "layout_left.json").read_text())
        self.p = told["parameters"]
        self.told = told["sides"]["left"]
        self.cell: dict[str, Any] = told.get("cell") or {"kind": "tile"}
        self.bottom = self.p["pad_thickness"] + self.p["taxel_protrusion"]
        self.ceiling = self.bottom + self.p["pocket_depth"]
        self.floor = self.ceiling + self.p["floor"]
        self.centres = 1000.0 * np.array([t["position"] for t in self.layout["taxels"]])[:, :2]
        self.chance = np.random.default_rng(1)

    def problems(self) -> list[str]:
        """What a buyer would complain about; empty for a good shoe."""
        fit = [("place", self._place), ("way on", self._way_on)]
        checks = [
            ("solid", self._solid),
            ("pockets", self._pockets),
            ("floor", self._floor),
            *(fit if self.kind == "shoe" else [("outline", self._outline)]),
            ("cable", self._cable),
            ("wall", self._wall),
            ("pad", self._pad),
            ("load", self._load),
        ]
        return [f"{name}: {text}" for name, check in checks if (text := check())]

    def _outline(self) -> str:
        """An insole lies within the foot, and its upper face is as high as its parameters add up to."""
        beyond = self.mesh.bounds[:, :2] - np.array([self.foot[..., :2].min((0, 1)), self.foot[..., :2].max((0, 1))])
        flat = abs(self.mesh.bounds[1, 2] - self.floor) < 1e-3
        inside = bool((beyond[0] > 0.0).all() and (beyond[1] < 0.0).all())
        return "" if inside and flat else f"reaches {beyond.tolist()} beyond the foot, top at {self.mesh.bounds[1, 2]}"

    def _load(self) -> str:
        """The taxels' share of the load case, by springs of a grid under a plate that sinks and tilts (bisected)."""
        x, y = self.mesh.bounds[:, 0], self.mesh.bounds[:, 1]
        step = 4.0
        px, py = (v.ravel() for v in np.meshgrid(np.arange(x[0], x[1], step), np.arange(y[0], y[1], step)))
        corners = 1e3 * np.array(self.layout["vertices"])[:, :2]
        cells = [corners[t["corners"]] for t in self.layout["taxels"]]
        outline = np.array(self.layout["outline"])[:, :2] * 1e3
        taxel = np.any([shapely.contains_xy(shapely.Polygon(c), px, py) for c in cells], axis=0)
        face = shapely.contains_xy(shapely.Polygon(outline), px, py)
        area, around = np.median([(c.area, c.length) for c in map(shapely.Polygon, cells)], axis=0)
        soft = self.p["taxel_protrusion"] + self.p["pocket_depth"] - self.cell.get("thickness", 0.0)
        if self.cell["kind"] == "sheet":  # pressed by one land, which is free at its own edge alone
            recess = float(shapely.area(list(map(shapely.Polygon, cells))).sum())
            area, around = recess, 2.0 * np.sqrt(np.pi * recess)
        if self.p["pad_kind"] == "plate":  # a rigid plate: the middle of each half lies between the cells
            hull = shapely.MultiPoint(self.centres).convex_hull
            middle = 0.5 * (outline[:, 0].min() + outline[:, 0].max())
            heel = shapely.Polygon(outline) & shapely.box(outline[:, 0].min(), -1e3, middle, 1e3)
            return "" if hull.covers(heel.centroid) and hull.covers(shapely.Polygon(outline).centroid) else "tips"
        hardness = self.p["taxel_hardness" if self.cell["kind"] == "tile" else "pad_hardness"]
        bed = soft / _modulus(hardness, area, around, soft)
        bed += self.p["pad_thickness"] / _modulus(self.p["pad_hardness"], area, around, self.p["pad_thickness"])
        beside = face & ~taxel
        rim = self.p["pad_thickness"] + self.p["taxel_protrusion"] - self.p["pad_relief"]
        # as stiff as a rim can be: bonded over all of the face's area
        hard = (
            _modulus(self.p["pad_hardness"], shapely.Polygon(outline).area, shapely.Polygon(outline).length, rim) / rim
        )
        k = np.where(taxel, 1.0 / bed, np.where(beside, hard, 0.0)) * step**2
        gap = np.where(taxel, 0.0, self.p["pad_relief"])
        force = self.told["load"]["force"]
        held = face & (px < 0.5 * (outline[:, 0].min() + outline[:, 0].max()))
        bad = []
        for what, on, least in (("flat", face, 0.95), ("heel", held, 0.80)):
            share = _share(np.column_stack([px, py])[on], k[on], gap[on], taxel[on], force)
            bad += [f"{what} {share:.2f}"] if share < least else []
        return "the taxels carry " + ", ".join(bad) if bad else ""

    def _solid(self) -> str:
        good = self.mesh.is_watertight and self.mesh.is_winding_consistent and self.mesh.body_count == 1
        return "" if good else "not one closed body"

    def _pockets(self) -> str:
        """From below each taxel's middle the print begins at the pocket's ceiling."""
        up = np.array([0.0, 0.0, 1.0])
        heights = [hits(self.triangles, np.array([x, y, -1.0]), up)[:1] - 1.0 for x, y in self.centres + 0.0137]
        low = [round(float(h[0]), 3) if len(h) else -1.0 for h in heights]
        bad = [v for v in low if abs(v - self.ceiling) > 0.01 and v < self.ceiling]
        return f"ceilings at {bad[:4]}, not {self.ceiling}" if bad else ""

    def _floor(self) -> str:
        """Below what the foot stands on there is plate up to the floor."""
        lowest = self.foot.reshape(-1, 3)[self.foot.reshape(-1, 3)[:, 2] < 0.3, :2]
        picked = lowest[self.chance.choice(len(lowest), min(40, len(lowest)), replace=False)]
        inside = picked + 0.05 * (picked.mean(axis=0) - picked)
        down, missing = np.array([0.0, 0.0, -1.0]), 0
        for x, y in inside:
            met = hits(self.triangles, np.array([x + 1.1e-3, y, self.floor + 3.0]), down)
            depth = met[0] - 3.0 if len(met) else 99.0
            missing += not -0.01 < depth <= self.p["mark_depth"] + 0.01
        return f"{missing} of {len(inside)} places have no floor" if missing > 0.1 * len(inside) else ""

    def _samples(self, top: float) -> Array:
        """Points (k, 3) on the foot below a height."""
        areas = np.linalg.norm(np.cross(self.foot[:, 1] - self.foot[:, 0], self.foot[:, 2] - self.foot[:, 0]), axis=1)
        pick = self.foot[self.chance.choice(len(self.foot), 1500, p=areas / areas.sum())]
        w = np.sort(self.chance.random((len(pick), 2)), axis=1)
        points = w[:, :1] * pick[:, 0] + (w[:, 1:] - w[:, :1]) * pick[:, 1] + (1.0 - w[:, 1:]) * pick[:, 2]
        return np.asarray(points[(points[:, 2] > 0.05) & (points[:, 2] < top)])

    def _inside(self, points: Array) -> int:
        """How many points lie within the print: rays upwards leave it an odd number of times."""
        up = np.array([1e-4, 2e-4, 1.0])
        return sum(len(hits(self.triangles, p, up)) % 2 for p in points)

    def _place(self) -> str:
        points = self._samples(self.p["rim_height"])[:120] + np.array([0.0, 0.0, self.floor])
        count = self._inside(points)
        return f"{count} points of the foot lie within the print" if count else ""

    def _way_on(self) -> str:
        """The foot comes from above: over each point of it below the wall's edge the wall leaves the way free."""
        up, blocked = np.array([0.0, 0.0, 1.0]), 0
        points = self._samples(self.p["rim_height"])[:120] + np.array([0.0, 0.0, self.floor])
        for point in points:
            met = hits(self.triangles, point, up)
            blocked += bool(len(met) and met[0] < self.floor + self.p["rim_height"] - point[2] - 0.05)
        return f"the way of {blocked} points of the foot is blocked" if blocked > 0.02 * len(points) else ""

    def _cable(self) -> str:
        """Just below the ceilings a way leads from each pocket to the shoe's outside, through ports and channel."""
        z = 0.5 * (self.bottom + self.p["scribe"] + self.ceiling)
        cut = trimesh.intersections.mesh_plane(self.mesh, [0, 0, 1], [0, 0, z])[..., :2]
        step = 0.8
        low, high = self.mesh.bounds[0, :2] - 4.0, self.mesh.bounds[1, :2] + 4.0
        xs, ys = np.arange(low[0], high[0], step), np.arange(low[1], high[1], step)
        free = np.stack([_even(cut, x, ys) for x in xs + 1.7e-4])
        parts, _ = label(free)
        # the channel ends in the board's hole, which is open above and below
        outside = {parts[0, 0], *self._open_parts(parts, xs, ys)}
        at = ((self.centres - low) / step).round().astype(int)
        shut = [int(k) for k, (i, j) in enumerate(at) if parts[i, j] not in outside]
        return f"no way out of the pockets {shut[:5]}" if shut else ""

    def _open_parts(self, parts: Array, xs: Array, ys: Array) -> set[int]:
        """What is connected with a place that is open upwards, past the wall, as the board's hole is."""
        up, z = np.array([0.0, 0.0, 1.0]), 0.5 * (self.bottom + self.p["scribe"] + self.ceiling)
        places = np.argwhere((parts > 0) & (parts != parts[0, 0]))[::7]
        open_up = [not len(hits(self.triangles, np.array([xs[i] + 1e-3, ys[j] + 1e-3, z]), up)) for i, j in places]
        return set(parts[tuple(places[open_up].T)].tolist())

    def _wall(self) -> str:
        """Rays into the print, against the faces' normals, leave it again no sooner than the thinnest wall."""
        flat = np.flatnonzero(self.mesh.area_faces > 8.0)
        pick = self.chance.choice(flat, min(250, len(flat)), replace=False)
        thin = []
        for face in pick:
            normal = self.mesh.face_normals[face]
            start = self.mesh.triangles_center[face] - 1e-4 * normal
            met = hits(self.triangles, start, -normal)
            if len(met) and met[0] < self.p["wall_min"] - 0.02 and abs(normal[2]) > 0.99:
                thin.append(round(float(met[0]), 3))
        return f"thin places: {thin[:4]}" if thin else ""

    def _on_lands(self, points: Array) -> NDArray[np.bool_]:
        """Which points of the pad are within a cell, or within the outermost of a sheet."""
        corners = 1e3 * np.array(self.layout["vertices"])[:, :2]
        near = np.zeros(len(points), dtype=bool)
        for taxel in self.layout["taxels"]:
            ring = corners[taxel["corners"]]
            middle = ring.mean(axis=0)
            near |= shapely.contains_xy(shapely.Polygon(middle + (1.0 + 1e-3) * (ring - middle)), points[:, :2])
        return near

    def _pad(self) -> str:
        """Under the taxels the pad ends at their heads; beside them it stays below the print by the relief."""
        up, bad = np.array([0.0, 0.0, 1.0]), 0
        pressed = self.cell["kind"] != "tile"  # by lands of the pad, up to the face of the film or the sheet
        head = self.ceiling - self.cell["thickness"] if pressed else self.p["pad_thickness"]
        for x, y in self.centres:
            met = hits(np.asarray(self.pad.triangles), np.array([x + 2e-3, y + 1e-3, -1.0]), up)
            bad += len(met) < 2 or abs(met[-1] - 1.0 - head) > 0.01
        points = self.pad.vertices
        lands = self._on_lands(points) if pressed else np.zeros(len(points), dtype=bool)
        top = float(points[~lands, 2].max())
        if top > self.bottom - min(self.p["pad_relief"], self.p["taxel_protrusion"]) + 0.01:
            return f"its rim reaches {top} mm, the print begins at {self.bottom}"
        return f"{bad} taxels have no sheet below them" if bad else ""
