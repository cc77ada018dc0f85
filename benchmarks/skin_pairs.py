"""Whether the left and right bodies of public robots get mirrored cells.

    python benchmarks/skin_pairs.py PATH... [--pairs 4] [--output my_page.md]

Paths are model files, or folders with some. Pairs are bodies whose names differ by their side; of each model some of
them, evenly among all, get four skins: the sole (where the two are mirrored in the reference pose, too: a sole is what
is lowest there), a patch by a drawn direction, one round a drawn axis and one in half of the body, and the other side
the same ones mirrored. How two bodies mirror each other is found from their shapes
alone: of the 24 ways in which axes can be mirrored, the one that brings corners, ends and radii nearest to those of the
other body. Cells are compared in that way, in order, with places, axes and areas.
"""

import argparse
import itertools
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).resolve().parent))
from skin_touches import models_below

from plantar.bench.tables import markdown_table
from plantar.errors import PlantarError
from plantar.mujoco import Skin
from plantar.mujoco.mirrored_body import MIRRORINGS

KINDS = mujoco.mjtGeom
ROOT = Path(__file__).resolve().parents[1]
ALIKE = 1e-5  # m: bodies whose shapes differ by more are no mirrored ones; a float32 mesh of a metre differs by 1e-7
SIDES = (("left", "right"), ("l", "r"), ("fl", "fr"), ("rl", "rr"), ("hl", "hr"), ("lf", "rf"), ("lh", "rh"))
PAGE = """# Skins of the left and the right

`python benchmarks/skin_pairs.py` of the files of {count} public models; commit {commit}. Its `--help` has what is
compared. *Shapes differ*: farthest corner, end or radius of a body's shapes from the mirrored ones of the other body in
m, of the pairs that differ by 0.01 mm at most. *Cells differ*: farthest place, axis (a direction's components) or area
(in m²) of their cells; 1e-12 is asked for. *Other pairs* differ by more: they are not mirrored. *Refused* on both sides
are drawn patches where a body has no surface or a strip; *on one* are those that only one side refuses.

"""
HEAD = ("pairs", "shapes differ, m", "skins", "taxels", "cells differ", "other pairs", "refused", "on one")


class Pair(NamedTuple):
    """Names of two bodies; `way` (3, 3): from the right one's frame to the left one's; `off`: of their shapes in m."""

    left: str
    right: str
    way: NDArray[np.float64]
    off: float


def other_name(name: str, names: set[str]) -> str | None:
    """The name of the left body of a right one."""
    for left, right in SIDES:
        for match in re.finditer(right, name, re.IGNORECASE):
            before = name[: match.start()][-1:]
            after = name[match.end() :][:1]
            if len(right) < 3 and (before.isalpha() or after.islower()):
                continue
            word = "".join(a.upper() if b.isupper() else a for a, b in zip(left, match.group().ljust(5), strict=False))
            found = name[: match.start()] + word + name[match.end() :]
            if found in names:
                return found
    return None


def features(model: Any, body: int) -> NDArray[np.float64]:
    """Places, radii and kinds (k, 5) of corners and ends of the shapes of a body and what is fixed to it."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    frame = data.xmat[body].reshape(3, 3)
    fixed = {body}
    for child in range(body + 1, model.nbody):
        if model.body_parentid[child] in fixed and not model.body_jntnum[child]:
            fixed.add(child)
    rows = []
    for g in range(model.ngeom):
        if model.geom_bodyid[g] not in fixed or not (model.geom_contype[g] or model.geom_conaffinity[g]):
            continue
        kind = int(model.geom_type[g])
        size = model.geom_size[g]
        radius = 0.0
        if kind == KINDS.mjGEOM_MESH:
            mesh = int(model.geom_dataid[g])
            first = int(model.mesh_vertadr[mesh])
            local = model.mesh_vert[first : first + int(model.mesh_vertnum[mesh])].astype(float)
            start = int(model.mesh_graphadr[mesh])
            if start >= 0:
                count = int(model.mesh_graph[start])
                local = local[model.mesh_graph[start + 2 + count : start + 2 + 2 * count]]
        elif kind == KINDS.mjGEOM_BOX:
            local = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * size
        elif kind == KINDS.mjGEOM_ELLIPSOID:
            local = np.vstack([np.diag(size), -np.diag(size)])
        else:
            radius = float(size[0])
            half = 0.0 if kind == KINDS.mjGEOM_SPHERE else float(size[1])
            local = np.array([[0.0, 0.0, half], [0.0, 0.0, -half]])
        placed = (local @ data.geom_xmat[g].reshape(3, 3).T + data.geom_xpos[g] - data.xpos[body]) @ frame
        rows.append(np.column_stack([placed, np.full((len(placed), 2), [radius, float(kind)])]))
    return np.vstack(rows) if rows else np.zeros((0, 5))


def paired(model: Any, left: str, right: str) -> Pair | None:
    """The pair, and the way that mirrors it best; None without shapes."""
    one = features(model, model.body(left).id)
    two = features(model, model.body(right).id)
    if not len(one) or not len(two):
        return None
    tree = cKDTree(one)
    best = None
    for way in MIRRORINGS:
        seen = np.column_stack([two[:, :3] @ way.T, two[:, 3:]])
        off = max(float(tree.query(seen)[0].max()), float(cKDTree(seen).query(one)[0].max()))
        if best is None or off < 0.5 * best.off - 1e-12:
            best = Pair(left, right, way, off)
    return best


def pairs_of(model: Any) -> list[Pair]:
    """All pairs of bodies with shapes that move."""
    names = {model.body(b).name for b in range(1, model.nbody)}
    found = []
    for b in range(1, model.nbody):
        right = model.body(b).name
        left = other_name(right, names)
        if left is not None and model.body_weldid[b] and (pair := paired(model, left, right)) is not None:
            found.append(pair)
    return found


def mirrored_region(region: NDArray[np.float64], way: NDArray[np.float64]) -> NDArray[np.float64]:
    ends = region @ way
    return np.array([ends.min(axis=0), ends.max(axis=0)])


def is_posed(model: Any, pair: Pair) -> bool:
    """Whether the bodies are turned as mirrored ones in the reference pose."""
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    left, right = (data.body(name).xmat.reshape(3, 3) for name in (pair.left, pair.right))
    return bool(np.abs(left @ pair.way - np.diag([1.0, -1.0, 1.0]) @ right).max() < ALIKE)


def skins_of(model: Any, pair: Pair, rng: np.random.Generator) -> Iterator[tuple[Skin, Skin]]:
    """The left and the right skin of each kind; `x @ way` brings a direction of the left body to the right one."""
    if is_posed(model, pair):
        yield Skin(body=pair.left), Skin(body=pair.right)
    out = rng.normal(size=3)
    yield Skin(body=pair.left, outward=out), Skin(body=pair.right, outward=out @ pair.way)
    axis = np.eye(3)[rng.integers(3)]
    yield Skin(body=pair.left, around=axis), Skin(body=pair.right, around=axis @ pair.way)
    half = np.array([[-9.0] * 3, [9.0] * 3])
    half[rng.integers(2), rng.integers(3)] = 0.0
    options: dict[str, Any] = {"region": half}
    yield Skin(body=pair.left, **options), Skin(body=pair.right, region=mirrored_region(half, pair.way))


def difference(one: Any, two: Any, way: NDArray[np.float64]) -> float:
    """Farthest that the right patch's cells are from the left one's, mirrored; inf for another number."""
    if len(one) != len(two):
        return float("inf")
    return max(
        float(np.abs(two.positions @ way.T - one.positions).max()),
        float(np.abs(two.rotations[:, :, 2] @ way.T - one.rotations[:, :, 2]).max()),
        float(np.abs(two.areas - one.areas).max()),
    )


def row(name: str, model: Any, most: int) -> list[str] | None:
    every = pairs_of(model)
    alike = [pair for pair in every if pair.off <= ALIKE]
    if not alike:
        return None
    rng = np.random.default_rng(0)
    chosen = [alike[i] for i in np.unique(np.linspace(0, len(alike) - 1, min(most, len(alike))).astype(int))]
    skins = 0
    taxels = 0
    refused = 0
    alone = 0
    worst = 0.0
    for pair in chosen:
        for left, right in skins_of(model, pair, rng):
            patches = []
            for skin in (left, right):
                try:
                    patches.append(skin.bind(model).patch)
                except PlantarError:
                    continue
            if len(patches) < 2:
                refused += not patches
                alone += len(patches)
                continue
            skins += 1
            taxels += len(patches[0])
            worst = max(worst, difference(*patches, pair.way))
            if "-v" in sys.argv and difference(*patches, pair.way) > 1e-12:
                print(pair, vars(left), len(patches[0]), len(patches[1]), difference(*patches, pair.way))
    off = max(pair.off for pair in chosen)
    return [
        name, str(len(chosen)), f"{off:.0e}", str(skins), str(taxels), f"{worst:.0e}", str(len(every) - len(alike)),
        str(refused), str(alone),
    ]  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", type=Path, help="model files, or folders with some")
    parser.add_argument("--pairs", type=int, default=4, help="most pairs a model (4)")
    parser.add_argument("-v", action="store_true", help="print each skin that is not mirrored")
    parser.add_argument("--output", type=Path, default=Path(__file__).with_suffix(".md"))
    options = parser.parse_args()
    rows: list[list[str]] = []
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=ROOT).stdout
    for path in options.paths:
        for name, spec in models_below(path):
            found = row(name, spec.compile(), options.pairs)
            print(found or f"{name} has no mirrored pairs", flush=True)
            if found is not None:
                rows.append(found)
                page = PAGE.format(count=len(rows), commit=commit.strip())
                options.output.write_text(page + markdown_table(["model", *HEAD], rows))


if __name__ == "__main__":
    main()
