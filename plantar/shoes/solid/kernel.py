"""Blocks added and cut: the only file running OpenCascade booleans. In mm."""

from collections.abc import Iterable, Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library
from plantar.errors import FootError
from plantar.shoes.geometry.outline import ring
from plantar.shoes.plan.block import Block, Groove, Step
from plantar.shoes.solid.polyhedron import Polyhedron
from plantar.shoes.solid.short_edges import without_short_edges


@cache
def load_kernel() -> Any:
    """OpenCascade's module with all packages; loading takes a second."""
    with optional_library("OCP", "shoes"):
        import OCP
        import OCP.TopoDS  # gives names of the version before
    # It prints what it finds wrong in a file to stdout, which belongs to the command; errors are raised anyhow.
    OCP.Message.Message.DefaultMessenger_s().RemovePrinters(OCP.Message.Message_PrinterOStream.get_type_descriptor_s())
    return OCP


class _Kernel:
    """OpenCascade's packages, loaded at first use."""

    def __getattr__(self, package: str) -> Any:
        return getattr(load_kernel(), package)


ocp = _Kernel()

SHORTEST = 0.2  # shortest edge of a solid in mm
_BELOW = 0.5  # mm that a groove's solid reaches below the print

Points = Sequence[Any] | NDArray[np.float64]


def build_solid(steps: Sequence[Step]) -> Polyhedron:
    """One shoe's solid in the sole frame: blocks added and cut in order; the first step adds."""
    load_kernel()
    try:
        shape = _assembled(steps)
        solids = len(parts_of(shape, ocp.TopAbs.TopAbs_SOLID))
        if solids == 1:
            return without_short_edges(_polyhedron(shape), SHORTEST)
    except Exception as error:  # the kernel raises of every kind
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FootError(f"the CAD kernel cannot build this shoe ({reason}); change a dimension a little") from None
    raise FootError(f"the shoe falls into {solids} solids; use a thicker border, rim or floor")


def _assembled(steps: Sequence[Step]) -> Any:
    shape: Any = None
    for step in steps:
        bodies = [_body(block) for block in step.blocks]
        if not bodies:
            continue
        if step.within is not None:
            low = min(b.z_low for b in step.blocks)
            high = max(b.z_high for b in step.blocks)
            limit = _prism(Block(step.within, low - 1.0, high + 1.0))
            together = _combined(ocp.BRepAlgoAPI.BRepAlgoAPI_Fuse, bodies[:1], bodies[1:])
            bodies = [_combined(ocp.BRepAlgoAPI.BRepAlgoAPI_Common, [together], [limit])]
        every = [*([] if shape is None else [shape]), *bodies]
        shape = _combined(
            ocp.BRepAlgoAPI.BRepAlgoAPI_Fuse if step.kind == "add" else ocp.BRepAlgoAPI.BRepAlgoAPI_Cut,
            every[:1],
            every[1:],
        )
    unified = ocp.ShapeUpgrade.ShapeUpgrade_UnifySameDomain(shape, True, True, True)
    unified.Build()
    return unified.Shape()


def _combined(operation: Any, arguments: Iterable[Any], tools: Sequence[Any]) -> Any:
    """Kernel boolean without history and copies, which take a fifth of the time."""
    if not tools:
        return next(iter(arguments))
    lists = ocp.TopTools.TopTools_ListOfShape(), ocp.TopTools.TopTools_ListOfShape()
    for shapes, held in zip((arguments, tools), lists, strict=True):
        for shape in shapes:
            held.Append(shape)
    made = operation()
    made.SetArguments(lists[0])
    made.SetTools(lists[1])
    made.SetToFillHistory(False)
    made.SetNonDestructive(False)
    made.SetCheckInverted(False)
    made.Build()
    if not made.IsDone():
        raise ValueError("a boolean operation fails")
    return made.Shape()


def _body(block: Block | Groove) -> Any:
    if isinstance(block, Groove):
        line = ring(block.line)
        edge = ring(block.edge)
        low = block.z_low - _BELOW
        levels = [_at(line, low), _at(line, block.z_high), _at(edge, block.z_low), _at(edge, low)]
        return _solid([_face(levels[0][::-1], levels[-1]), *(q for pair in pairwise(levels) for q in _sides(*pair))])
    if block.high is None:
        return _prism(block)
    levels = [_at(ring(block.low), block.z_low), _at(ring(block.high), block.z_high)]
    return _solid([_face(levels[0][::-1]), _face(levels[1]), *_sides(*levels)])


def _at(points: Points, z: float) -> list[tuple[float, float, float]]:
    return [(float(x), float(y), z) for x, y in points]


def _sides(low: Points, high: Points) -> list[Any]:
    return [_face([low[i - 1], low[i], high[i], high[i - 1]]) for i in range(len(low))]


def _wire(points: Points) -> Any:
    made = ocp.BRepBuilderAPI.BRepBuilderAPI_MakePolygon()
    for point in points:
        made.Add(ocp.gp.gp_Pnt(*point))
    made.Close()
    return made.Wire()


def _face(outer: Points, *holes: Points) -> Any:
    made = ocp.BRepBuilderAPI.BRepBuilderAPI_MakeFace(_wire(outer), True)
    for hole in holes:
        made.Add(_wire(hole))
    return made.Face()


def _prism(block: Block) -> Any:
    holes = [np.asarray(h.coords)[:-1] if not h.is_ccw else np.asarray(h.coords)[:0:-1] for h in block.low.interiors]
    face = _face(_at(ring(block.low), block.z_low), *(_at(h, block.z_low) for h in holes))
    return ocp.BRepPrimAPI.BRepPrimAPI_MakePrism(face, ocp.gp.gp_Vec(0.0, 0.0, block.z_high - block.z_low)).Shape()


def _solid(faces: list[Any]) -> Any:
    sewn = ocp.BRepBuilderAPI.BRepBuilderAPI_Sewing(1e-6)
    for face in faces:
        sewn.Add(face)
    sewn.Perform()
    return ocp.BRepBuilderAPI.BRepBuilderAPI_MakeSolid(ocp.TopoDS.TopoDS.Shell_s(sewn.SewedShape())).Solid()


def parts_of(shape: Any, kind: Any) -> list[Any]:
    """Gives different parts of a kind (a `TopAbs` type) of a kernel shape."""
    found = ocp.TopTools.TopTools_IndexedMapOfShape()
    ocp.TopExp.TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(i + 1) for i in range(found.Size())]


def points_of(shape: Any) -> NDArray[np.float64]:
    """Kernel shape's corners (n, 3) in mm."""
    corners = parts_of(shape, ocp.TopAbs.TopAbs_VERTEX)
    return np.array([ocp.BRep.BRep_Tool.Pnt_s(ocp.TopoDS.TopoDS.Vertex_s(v)).Coord() for v in corners])


def _polyhedron(shape: Any) -> Polyhedron:
    found = ocp.TopTools.TopTools_IndexedMapOfShape()
    ocp.TopExp.TopExp.MapShapes_s(shape, ocp.TopAbs.TopAbs_VERTEX, found)
    faces = []
    for face in map(ocp.TopoDS.TopoDS.Face_s, parts_of(shape, ocp.TopAbs.TopAbs_FACE)):
        loops: list[tuple[int, ...]] = []
        outer = ocp.BRepTools.BRepTools.OuterWire_s(face)
        for wire in map(ocp.TopoDS.TopoDS.Wire_s, parts_of(face, ocp.TopAbs.TopAbs_WIRE)):
            edges = ocp.BRepTools.BRepTools_WireExplorer(wire, face)
            loop = list[int]()
            while edges.More():
                loop.append(found.FindIndex(edges.CurrentVertex()) - 1)
                edges.Next()
            loops.insert(0 if wire.IsSame(outer) else len(loops), tuple(loop))
        faces.append(tuple(loops))
    return Polyhedron(points_of(shape), tuple(faces))
