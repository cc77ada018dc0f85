"""The printable solid, built from blocks. The only file that builds with cadquery."""

from __future__ import annotations

import os
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.cad_kernel import load_cadquery
from plantar.shoes.geometry.outline import ring
from plantar.shoes.plan.block import Block, Groove, Step

__all__ = ["build_solid", "read_step", "surface_of", "write_step"]


def build_solid(steps: Sequence[Step]) -> Any:
    """Build the solid of one shoe.

    Frame: the sole frame in mm; the contact face is z = 0.

    Args:
        steps: What is added and cut, in order; the first adds.

    Returns:
        The cadquery solid.

    Raises:
        FootError: If the blocks do not give one solid.
    """
    cq = load_cadquery()
    try:
        shape = _assembled(cq, steps)
    except Exception as error:  # the kernel raises of every kind
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FootError(f"the CAD kernel cannot build this shoe ({reason}); change a dimension a little") from None
    solids = shape.Solids()
    if len(solids) != 1:
        raise FootError(f"the shoe falls into {len(solids)} solids; use a thicker border, rim or floor")
    return solids[0]


def _assembled(cq: Any, steps: Sequence[Step]) -> Any:
    """The shape after all steps."""
    shape: Any = None
    for step in steps:
        bodies = [_body(cq, block) for block in step.blocks]
        if not bodies:
            continue
        if step.within is not None:
            low, high = min(b.z_low for b in step.blocks), max(b.z_high for b in step.blocks)
            limit = _body(cq, Block(step.within, low - 1.0, high + 1.0))
            first, *others = bodies
            shape = shape.fuse((first.fuse(*others) if others else first).intersect(limit))
        elif shape is None:
            shape, *bodies = bodies
            shape = shape.fuse(*bodies) if bodies else shape
        else:
            shape = shape.fuse(*bodies) if step.kind == "add" else shape.cut(*bodies)
    return shape.clean()


def _body(cq: Any, block: Block | Groove) -> Any:
    """The solid of a block."""
    if isinstance(block, Groove):
        return _groove(cq, block)
    if block.high is None:
        outer = _wire(cq, ring(block.low), block.z_low)
        inner = [_wire(cq, np.asarray(h.coords)[:-1], block.z_low) for h in block.low.interiors]
        return cq.Solid.extrudeLinear(outer, inner, cq.Vector(0.0, 0.0, block.z_high - block.z_low))
    low = [cq.Vector(float(x), float(y), block.z_low) for x, y in ring(block.low)]
    high = [cq.Vector(float(x), float(y), block.z_high) for x, y in ring(block.high)]
    count = len(low)
    corners = [low[::-1], high]
    corners += [[low[i], low[(i + 1) % count], high[(i + 1) % count], high[i]] for i in range(count)]
    faces = [cq.Face.makeFromWires(cq.Wire.makePolygon(c, close=True)) for c in corners]
    return cq.Solid.makeSolid(cq.Shell.makeShell(faces))


def _groove(cq: Any, groove: Groove) -> Any:
    """The solid of a half groove."""
    line, edge = ring(groove.line), ring(groove.edge)
    open_end = groove.z_low - 0.5

    def at(points: NDArray[np.float64], z: float) -> list[Any]:
        return [cq.Vector(float(x), float(y), z) for x, y in points]

    rings = [at(line, open_end), at(line, groove.z_high), at(edge, groove.z_low), at(edge, open_end)]
    faces = [cq.Face.makeFromWires(_wire(cq, line, open_end), [_wire(cq, edge, open_end)])]
    for low, high in pairwise(rings):
        for i in range(len(line)):
            j = (i + 1) % len(line)
            faces.append(cq.Face.makeFromWires(cq.Wire.makePolygon([low[i], low[j], high[j], high[i]], close=True)))
    return cq.Solid.makeSolid(cq.Shell.makeShell(faces))


def _wire(cq: Any, points: NDArray[np.float64], z: float) -> Any:
    return cq.Wire.makePolygon([cq.Vector(float(x), float(y), z) for x, y in points], close=True)


def surface_of(solid: Any) -> NDArray[np.float64]:
    """Triangles (n, 3, 3) of a solid's surface in mm, with corners rounded to 1e-6 mm; all its faces are flat."""
    vertices, faces = solid.tessellate(0.01, 0.1)
    points = np.array([v.toTuple() for v in vertices], dtype=float).round(6) + 0.0
    return np.asarray(points[np.array(faces, dtype=np.int64)])


def write_step(solid: Any, path: str, name: str = "shoe") -> None:
    """Write a solid as STEP (mm), named as a product; the same solid gives the same file.

    Args:
        solid: Solid in mm.
        path: File to write.
        name: Name of the product, as CAD shows it.

    The date in its header is that of the environment's SOURCE_DATE_EPOCH, or else the first of the year of Plantar's
    release: a date of writing would make two files of one solid differ.
    """
    import re
    from pathlib import Path

    cq = load_cadquery()
    cq.exporters.export(cq.Workplane(obj=solid), path, exportType="STEP")
    text = Path(path).read_text(encoding="utf-8")
    plain = "".join(c if c.isascii() and (c.isalnum() or c in " -_.") else " " for c in name)
    text = re.sub(r"FILE_NAME\('[^']*','[^']*'", f"FILE_NAME('{plain}','{_date()}'", text, count=1)
    text = re.sub(r"PRODUCT\('[^']*',\s*'[^']*'", f"PRODUCT('{plain}','{plain}'", text)
    text = re.sub(r"(STEP translator \d+\.\d+) \d+", r"\1", text)  # counts the exports of the process
    Path(path).write_text(text, encoding="utf-8")


def _date() -> str:
    """Date and time of what is written, the same for the same release."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    when = datetime.fromtimestamp(int(seconds), UTC) if seconds.isdigit() else datetime(2026, 1, 1, tzinfo=UTC)
    return when.strftime("%Y-%m-%dT%H:%M:%S")


def read_step(path: str) -> Any:
    """The shape of a STEP file as a cadquery shape."""
    return load_cadquery().importers.importStep(path).val()
