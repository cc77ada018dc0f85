"""The printable solid: a sole plate with a patch recess and taxel pockets below and a rim above. The only CAD file."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError, FootError
from shoes.outline import ring
from shoes.parameters import ShoeParameters
from shoes.plan import ShoePlan

__all__ = ["build_tray", "load_cadquery", "read_step", "surface_of", "write_step"]


def load_cadquery() -> Any:
    """The cadquery module; loading it takes seconds.

    Raises:
        DependencyError: If it is not installed.
    """
    try:
        import cadquery
    except ImportError:
        raise DependencyError("cadquery", "shoes") from None
    return cadquery


def build_tray(plan: ShoePlan, parameters: ShoeParameters) -> Any:
    """Build the solid of one shoe.

    Frame: the sole frame in mm; the contact face is z = 0, the foot stands on z = plate_thickness.

    Args:
        plan: Outlines seen from above.
        parameters: Heights and depths.

    Returns:
        The cadquery solid.

    Raises:
        FootError: If the outlines do not give one solid.
    """
    cq = load_cadquery()
    p = parameters
    plate = _prism(cq, plan.contact, 0.0, p.plate_thickness)
    rim = _prism(cq, plan.rim, 0.0, p.height)
    cuts = [_prism(cq, plan.cavity, p.plate_thickness, p.height + 1.0)]
    cuts += [_prism(cq, r, -1.0, p.patch_depth) for r in plan.recesses]
    cuts += [_prism(cq, h, 0.5 * p.patch_depth, p.patch_depth + p.pocket_depth) for h in plan.pockets]
    shape = plate.fuse(rim).cut(*cuts).clean()
    solids = shape.Solids()
    if len(solids) != 1:
        raise FootError(f"the shoe falls into {len(solids)} solids; use a thicker border, rim or plate")
    return solids[0]


def _prism(cq: Any, polygon: Any, low: float, high: float) -> Any:
    """A polygon extruded from z = low to z = high."""
    points = [cq.Vector(float(x), float(y), low) for x, y in ring(polygon)]
    wire = cq.Wire.makePolygon(points, close=True)
    return cq.Solid.extrudeLinear(wire, [], cq.Vector(0.0, 0.0, high - low))


def surface_of(solid: Any) -> NDArray[np.float64]:
    """Triangles (n, 3, 3) of a solid's surface in mm, with corners rounded to 1e-6 mm; all its faces are flat."""
    vertices, faces = solid.tessellate(0.01, 0.1)
    points = np.array([v.toTuple() for v in vertices], dtype=float).round(6) + 0.0
    return np.asarray(points[np.array(faces, dtype=np.int64)])


def write_step(solid: Any, path: str) -> None:
    """Write a solid as STEP (mm); its header is fixed, so that the same solid gives the same file.

    Args:
        solid: Solid in mm.
        path: File to write.
    """
    import re
    from pathlib import Path

    cq = load_cadquery()
    cq.exporters.export(cq.Workplane(obj=solid), path, exportType="STEP")
    text = Path(path).read_text(encoding="utf-8")
    text = re.sub(r"(FILE_NAME\('[^']*',)'[^']*'", r"\1'2000-01-01T00:00:00'", text, count=1)
    text = re.sub(r"(STEP translator \d+\.\d+) \d+", r"\1", text)  # counts the exports of the process
    Path(path).write_text(text, encoding="utf-8")


def read_step(path: str) -> Any:
    """The shape of a STEP file as a cadquery shape."""
    return load_cadquery().importers.importStep(path).val()
