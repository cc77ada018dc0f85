"""Orientation of a foot: up, tilt and toes. Triangles (n, 3, 3) in mm."""

import math
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library
from plantar.errors import FootError
from plantar.geometry.hull_plane import hull_plane
from plantar.shoes.geometry.outline import cut_below
from plantar.shoes.geometry.surface import convex_outline, corner_numbers, thinned

Axis = Literal["x", "-x", "y", "-y", "z", "-z"]  # an axis of a mesh, with its direction

AXES: tuple[Axis, ...] = ("x", "-x", "y", "-y", "z", "-z")  # all axes

_TILT_LEAST = math.radians(1.0)
_TILT_MOST = math.radians(25.0)
_SAME_PLANE = math.cos(math.radians(0.5))
_FACES = 12  # of the hull that are looked at for its largest plane
_NEAR = 1.0  # mm
_MANY = 100_000  # points, above which the lowest in each column are looked at
_COLUMN = 1.0  # mm
_RESTS = 0.3  # share of the silhouette that one plane of the hull must have to be what the foot rests on
# mm: how far what lies below reaches up, and a face on a side inwards
_BAND = 5.0
_DEEP = 2.0
_SIDE = 1.5  # of the face below: a face on a side that is so much larger is the sole
_SLANTED = "a slanted one"
_DECK_TILT = 3.0  # degrees by which a deck may be tilted over a sole that nothing levels
_DECK = 0.5  # of the silhouette: a plane above that is so large is the foot's deck
_AS_DRAWN = 0.3  # degrees within which a face was level before the foot was levelled
_EITHER = 0.8  # of the face below: a face above that is so large could be the sole
_UPWARD = 0.2  # of a normal: faces above are no sole
_LONGER = 1.05  # of the other side: what counts as the long side
_CLEAR = 0.06  # of the foot's length: how far the ankle lies from its middle where it shows the heel from the toes
_THIN = 0.05  # height over length: up to it the uppermost part of a plate that is tilted a little is no block
_BLOCK = 0.6  # of the foot's length: what is shorter on top of it is its ankle
_TURN_NOTED = 4.0  # degrees: a foot askew by more is noted
_TURN_SQUARE = 30.0  # degrees: a foot about as wide as long that stands so much askew could point either way
_TURN_LEAST = 6.0  # degrees: a foot turned by less is taken as it stands
_STRAIGHTER = 0.03  # by how much a foot is more like its mirror image where it is taken to be turned
_SECOND = 0.25  # of the largest body's area: what lies apart and is smaller is a loose part
_APART = 4.0  # mm between two bodies
_MOST_PARTS = 3000  # loose parts that are looked at one by one

Array = NDArray[np.float64]


def _direction(axis: Axis) -> Array:
    out = np.zeros(3)
    out["xyz".index(axis[-1])] = -1.0 if axis[0] == "-" else 1.0
    return out


def rotation_up(up: Axis) -> Array:
    """Rotation (3, 3) of a mesh axis to +z; x stays if possible."""
    z = _direction(up)
    x = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.5 else np.array([0.0, 1.0, 0.0])
    return np.stack([x, np.cross(z, x), z])


def rotation_forward(forward: Axis) -> Array:
    """Rotation (3, 3) about z of a horizontal mesh axis to +x."""
    x = _direction(forward)
    z = np.array([0.0, 0.0, 1.0])
    return np.stack([x, np.cross(z, x), z])


def _thinned(points: Array) -> Array:
    if len(points) <= _MANY:
        return np.unique(points.round(6), axis=0)
    order = points[np.argsort(points[:, 2], kind="stable")]
    _, first = np.unique(corner_numbers(order[:, :2] * (1e-3 / _COLUMN)), return_index=True)
    return np.asarray(order[first])


def _resting_plane(triangles: Array) -> tuple[Array, float]:
    """Normal of the largest plane on the hull's lower side, and its silhouette share."""
    points = _thinned(triangles.reshape(-1, 3))
    normal, area = hull_plane(points, -math.cos(_TILT_MOST), _SAME_PLANE, _FACES)
    return normal, area / convex_outline(points[:, :2]).area if area > 0.0 else 0.0


def _area_in_plane(triangles: Array, normal: Array, *, inwards: bool = False) -> float:
    """Area in mm^2 of faces in the outermost plane with a normal, inward ones too."""
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    double = np.linalg.norm(cross, axis=1)
    depth = triangles @ normal
    along = cross @ normal
    flat = (np.abs(along) if inwards else along) > _SAME_PLANE * double
    return float(0.5 * double[flat & (depth.max() - depth.min(axis=1) < _NEAR)].sum())


def _flat_area(triangles: Array, normal: Array) -> float:
    return float(_area_in_plane(triangles, normal, inwards=True) / convex_outline(triangles.reshape(-1, 3)[:, :2]).area)


def flat_share(triangles: Array) -> float:
    """Silhouette share from above, 0..1, of the foot's resting plane."""
    return _resting_plane(triangles)[1]


def levelled(triangles: Array) -> tuple[Array, float]:
    """Gives triangles, z about up, with the resting plane level, and the removed tilt in degrees, 0 if small or
    uncertain.
    """
    normal, share = _resting_plane(triangles)
    tilt = math.acos(min(1.0, -float(normal[2])))
    if share < _RESTS or tilt < _TILT_LEAST or _flat_area(triangles, normal) < _RESTS * share:
        return triangles, 0.0
    down = np.array([0.0, 0.0, -1.0])
    axis = np.cross(normal, down)
    axis /= np.linalg.norm(axis)
    k = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    turn = np.eye(3) + math.sin(tilt) * k + (1.0 - math.cos(tilt)) * k @ k
    return np.asarray(triangles @ turn.T), math.degrees(tilt)


def check_upright(triangles: Array, where: str) -> list[str]:
    """Refuse triangles in mm of a foot on its side, one with a face much larger than below; where is the file's name.

    Faces are compared by the hull of nearby points, along the axes and the hull's largest plane; those above do not
    count, since a deck may exceed the sole.

    Returns note where a side is about as large.
    """
    points = triangles.reshape(-1, 3)
    points = points if len(points) <= _MANY else thinned(points, _COLUMN)
    below = _face_area(points, _direction("-z"), _BAND)
    sides = [(_face_area(points, -_direction(axis), _DEEP), f"{axis} up") for axis in AXES[:4]]
    normal, found = hull_plane(points, _UPWARD, _SAME_PLANE, _FACES)
    slanted = _face_area(points, normal, _DEEP) if found > 0.0 else 0.0
    if _area_in_plane(triangles, normal) > _RESTS * slanted:  # over what juts out there are no faces
        sides.append((slanted, _SLANTED))
    area, which = max(sides, key=lambda side: round(side[0]))  # of equal ones an axis
    if area > _SIDE * below:
        raise FootError(
            f"{where}: the foot seems to lie on its side: {0.01 * below:.0f} cm2 lie below, and {0.01 * area:.0f} cm2 "
            f"on another side ({which}); give the axis that points up ({', '.join(AXES)}), or level the mesh"
        )
    if area > below:
        return [f"another side of the foot is as large as what lies below ({which}); check its orientation"]
    return []


def check_level(triangles: Array, where: str, levelled_by: float = 0.0) -> list[str]:
    """Refuse triangles in mm of a foot upside down, or tilted without resting plane; where is the file's name,
    levelled_by degrees removed.

    Returns notes on the undetectable: a rounded sole's level, and a foot upside down.
    """
    below, share = _resting_plane(triangles)
    flip = np.array([1.0, 1.0, -1.0])
    above, deck = _resting_plane(triangles * flip)
    tilt = math.degrees(math.acos(min(1.0, -float(above[2]))))
    if share < _RESTS or _flat_area(triangles, below) < _RESTS * share:
        if deck > _DECK and tilt > _DECK_TILT:
            raise FootError(
                f"{where}: the sole has no plane to be levelled by, and the upper side is tilted by {tilt:.1f} "
                "degrees, as the foot seems to be; level the mesh, or give the axis that points up (--up z) to take it "
                "as it stands"
            )
        return ["the sole has no plane to be levelled by: taken to be level as the mesh's axes are"]
    points = triangles.reshape(-1, 3)
    up = _face_area(points, above * flip, _DEEP)
    if up <= _EITHER * _face_area(points, _direction("-z"), _BAND) or (
        _area_in_plane(triangles, above * flip, inwards=True) < _RESTS * up  # over what juts out there are no faces
    ):
        return []
    if levelled_by > 0.0 and abs(tilt - levelled_by) < _AS_DRAWN:
        raise FootError(
            f"{where}: the foot seems to stand on its upper side: what lies below is tilted by {tilt:.1f} degrees, and "
            "what lies above is level; turn the mesh, or give the axis that points up (--up -z, or --up z to level it "
            "as it stands)"
        )
    return ["the foot could stand on its upper side as well: z is taken to point up (or give the axis that does)"]


def _face_area(points: Array, outward: Array, deep: float) -> float:
    """Hull area in mm^2 of points within `deep` mm of the farthest in a direction."""
    depth = points @ outward
    near = points[depth > depth.max() - deep]
    return float(convex_outline(near @ np.linalg.svd(outward[None])[2][1:].T).area)


def check_one_body(triangles: Array, where: str) -> None:
    """Refuse triangles in mm that show two feet; where is the file's name."""
    with optional_library("scipy", "shoes"):
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

    index = corner_numbers(triangles)
    a, b, c = index.T
    index = index.ravel()
    links = coo_array((np.ones(2 * len(a)), (np.concatenate([a, b]), np.concatenate([b, c]))))
    size = int(index.max()) + 1
    links.resize(size, size)
    count, label = connected_components(links, directed=False)
    if not 2 <= count <= _MOST_PARTS:
        return
    flat = triangles.reshape(-1, 3)[:, :2]
    order = np.argsort(label[index], kind="stable")
    ends = np.cumsum(np.bincount(label[index], minlength=count))[:-1]
    hulls = shapely.convex_hull([shapely.multipoints(flat[part]) for part in np.split(order, ends)])
    bodies = shapely.union_all(shapely.buffer(hulls, 0.5 * _APART))
    areas = sorted((g.area for g in getattr(bodies, "geoms", [bodies])), reverse=True)
    if len(areas) > 1 and areas[1] > _SECOND * areas[0]:
        raise FootError(
            f"{where}: holds {sum(v > _SECOND * areas[0] for v in areas)} bodies apart from each other, "
            "two feet maybe; give a file of one foot, or the forward axis of a foot in parts"
        )


def straightened(triangles: Array, where: str = "the mesh", *, sole_band: float = 5.0) -> tuple[Array, list[str]]:
    """Gives triangles with the sole's length along x or y, and notes; where is the file's name.

    Only the lowest `sole_band` mm count, since ankles and motors above are no mirror images. The direction is the one
    within 25 degrees of the sole's long axis with the best mirror symmetry.
    """
    below = cut_below(triangles, float(triangles[..., 2].min()) + sole_band)
    hull = convex_outline(below.reshape(-1, 3)[:, :2])
    if hull.geom_type != "Polygon":
        return triangles, []
    hull = hull.simplify(0.3)
    box = shapely.get_coordinates(shapely.minimum_rotated_rectangle(hull).exterior)
    sides = np.diff(box, axis=0)[:2]
    lengths = np.hypot(*sides.T)
    square = lengths.max() < _LONGER * lengths.min()
    along = sides[int(lengths.argmax())]
    start = math.degrees(math.atan2(along[1], along[0]))
    angles = start + np.arange(-25.0, 25.5, 0.5)
    alike = [_likeness(hull, v) for v in angles]
    best = float(angles[int(np.argmax(alike))])
    off = (best + 45.0) % 90.0 - 45.0
    if abs(off) < _TURN_NOTED or max(alike) - _likeness(hull, best - off) < _STRAIGHTER:
        return triangles, []
    if abs(off) < _TURN_LEAST:
        return triangles, [
            f"by the symmetry of its sole the foot points {off:.1f} degrees past an axis of the mesh: taken as it "
            f"stands, since that is less than {_TURN_LEAST:g}; turn the mesh if it should not"
        ]
    if square and abs(off) > _TURN_SQUARE:
        raise FootError(
            f"{where}: the sole is about as wide as long and stands askew by {abs(off):.0f} degrees, so that nothing "
            f"shows where it points; turn the mesh, or give the forward axis ({', '.join(AXES[:4])}) to take it as it "
            "stands"
        )
    c = math.cos(math.radians(-off))
    s = math.sin(math.radians(-off))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    note = (
        f"the foot points {off:.1f} degrees past an axis of the mesh, by the symmetry of its sole: turned back by that"
    )
    return np.asarray(triangles @ turn.T), [note]


def _likeness(outline: Any, degrees: float) -> float:
    level = shapely.affinity.rotate(outline, -degrees, origin="centroid")
    image = shapely.affinity.scale(level, 1.0, -1.0, origin="centroid")
    return float(level.intersection(image).area / level.union(image).area)


def forward_axis(triangles: Array, where: str = "the mesh") -> tuple[Axis, str]:
    """Gives horizontal axis of triangles to the toes, the longer one, away from the ankle (origin, or a block on top),
    and a note; where is the file's name.
    """
    points = triangles.reshape(-1, 3)
    low = points.min(axis=0)
    high = points.max(axis=0)
    size = high - low
    i = 1 if size[1] > _LONGER * size[0] else 0
    name = "xy"[i]
    middle = 0.5 * (low + high)
    clues: list[tuple[float, str]] = []
    if (low[:2] <= 0.0).all() and (high[:2] >= 0.0).all():
        clues.append((float(middle[i] / size[i]), "origin"))
    upper = points[points[:, 2] > high[2] - 0.15 * size[2], i]
    if size[2] > _THIN * size[i] and upper.max() - upper.min() < _BLOCK * size[i]:
        clues.append((float((middle[i] - 0.5 * (upper.max() + upper.min())) / size[i]), "uppermost part"))
    clues = [(share, what) for share, what in clues if abs(share) > _CLEAR]
    how = f"the foot is longer along {name}" if i else f"{name} points to the toes, as usual"
    if not clues:
        return ("y", f"{how}, taken to point to the toes (or give the forward axis)") if i else ("x", how)
    if len({share > 0.0 for share, _ in clues}) > 1:
        raise FootError(
            f"{where}: origin and uppermost part lie near opposite ends of the foot; give the forward axis "
            f"({', '.join(AXES[:4])})"
        )
    axis: Axis = ("x", "y")[i] if clues[0][0] > 0.0 else ("-x", "-y")[i]
    if axis == "x":
        return "x", how
    what = " and ".join(what for _, what in clues)
    verb = "lie" if len(clues) > 1 else "lies"
    return axis, f"the foot is longer along {name}, and its {what} {verb} nearer to the heel: {axis} points to the toes"
