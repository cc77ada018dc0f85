"""The left body that a right one mirrors: the skins of both are laid on the left one."""

import itertools
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.mujoco.geom_surface import GeomSurface, body_surfaces
from plantar.mujoco.sole_shape import rigid_geoms

_ALIKE = 1e-5  # m: shapes of two files are rounded, and meshes float32; a cell's place is not known to that
_SIDES = (("left", "right"), ("l", "r"), ("fl", "fr"), ("rl", "rr"), ("hl", "hr"), ("lf", "rf"), ("lh", "rh"))
_KINDS = mujoco.mjtGeom


class LeftBody(NamedTuple):
    """A left body: its id, geoms' ids and surfaces, and `way` (3, 3): from the right one's frame to its own."""

    body: int
    geoms: list[int]
    surfaces: list[GeomSurface]
    way: NDArray[np.float64]


def left_body(model: Any, body: int, surfaces: Sequence[GeomSurface]) -> LeftBody | None:
    """The left body whose shapes those of a right `body`, its `surfaces`, mirror to 0.01 mm; None without."""
    name = _left_name(model, model.body(body).name)
    if name is None:
        return None
    left = model.body(name).id
    geoms = rigid_geoms(model, left)
    try:
        its = body_surfaces(model, left, geoms)
    except RobotError:
        return None
    if sorted(s.kind for s in its) != sorted(s.kind for s in surfaces):
        return None
    way = _mirroring(_features(its), _features(surfaces))
    return None if way is None else LeftBody(left, geoms, its, way)


def _left_name(model: Any, name: str) -> str | None:
    """Name of the model's body that has the other side in its name than a right one; None for others."""
    for left, right in _SIDES:
        for match in re.finditer(right, name, re.IGNORECASE):
            word = match.group()
            before = name[: match.start()][-1:]
            after = name[match.end() :][:1]
            if len(right) < 3 and (before.isalpha() or after.islower()):
                continue  # a letter within a word
            other = left.upper() if word.isupper() else left.capitalize() if word[0].isupper() else left
            found = name[: match.start()] + other + name[match.end() :]
            if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, found) > 0:
                return found
    return None


def _features(surfaces: Sequence[GeomSurface]) -> NDArray[np.float64]:
    """Corners, or ends and radius, and kind (k, 5) of shapes: place, radius, kind."""
    rows = []
    for s in surfaces:
        radius = 0.0
        if len(s.corners):
            local = s.corners
        elif s.kind == _KINDS.mjGEOM_ELLIPSOID:
            local = np.vstack([np.diag(s.size), -np.diag(s.size)])
        else:
            radius = float(s.size[0])
            half = 0.0 if s.kind == _KINDS.mjGEOM_SPHERE else float(s.size[1])
            local = np.array([[0.0, 0.0, half], [0.0, 0.0, -half]])
        placed = local @ s.rotation.T + s.position
        rows.append(np.column_stack([placed, np.full((len(placed), 2), [radius, float(s.kind)])]))
    return np.vstack(rows)


def _mirroring(left: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """How axes of the right body's frame are mirrored (3, 3) for its features to be the left one's, y alone at best."""
    from scipy.spatial import cKDTree

    tree = cKDTree(left)
    best = None
    least = _ALIKE
    for way in MIRRORINGS:
        seen = np.column_stack([right[:, :3] @ way.T, right[:, 3:]])
        bounds = np.abs([seen.min(axis=0) - left.min(axis=0), seen.max(axis=0) - left.max(axis=0)]).max()
        if bounds > least:
            continue
        off = max(float(tree.query(seen)[0].max()), float(cKDTree(seen).query(left)[0].max()))
        if off <= least:
            best = way
            least = 0.5 * off - 1e-12  # of a symmetric shape the first
    return best


def _mirrorings() -> list[NDArray[np.float64]]:
    found = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1.0, -1.0), repeat=3):
            way = np.zeros((3, 3))
            way[range(3), order] = signs
            if np.linalg.det(way) < 0.0:
                found.append(way)
    return sorted(found, key=lambda way: float(np.abs(way - np.diag([1.0, -1.0, 1.0])).sum()))


MIRRORINGS = _mirrorings()
"""The 24 ways (3, 3) to mirror a frame's axes onto axes, that which only turns y first."""
