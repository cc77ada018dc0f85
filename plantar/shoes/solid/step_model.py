"""Solids as STEP files with named products, and reading them back. In mm."""

import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import cached_property
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.shoes.solid.arcs import Arc, CurvedSolid, with_arcs
from plantar.shoes.solid.kernel import ocp, parts_of, points_of
from plantar.shoes.solid.polyhedron import Loops, Polyhedron

_TOLERANCE = 1e-5  # mm
_SAME = 1e-6  # mm between the centres of a cone's two arcs

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StepPart:
    """Part of an assembly. `places`: shifts (3,) in mm by instance name."""

    name: str
    body: Polyhedron
    places: Mapping[str, tuple[float, float, float]]

    @cached_property
    def shape(self) -> Any:
        """Kernel solid, with arcs; with the polygons' own edges where the kernel finds faults in it with arcs."""
        curved = _solid(with_arcs(self.body))
        return curved if _faultless(curved) else _solid(CurvedSolid(self.body, {}, frozenset()))


@dataclass(frozen=True)
class StepSolid:
    """Solid of a STEP file.

    `valid`: without faults, by the kernel; `volume` in mm^3; `corners`: points (n, 3); `circles`: arc centre and radius
    (m, 4).
    """

    solids: int
    valid: bool
    volume: float
    corners: Array
    circles: Array
    shortest: float


def write_step(parts: Sequence[StepPart], path: str | os.PathLike[str], name: str) -> None:
    """Write parts, one or an assembly of a name, as STEP (mm) to a path; dated SOURCE_DATE_EPOCH or the release's year,
    for reproducible files.
    """
    plain = _plain(name)
    document = ocp.TDocStd.TDocStd_Document(ocp.TCollection.TCollection_ExtendedString("XmlOcaf"))
    shapes = ocp.XCAFDoc.XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    whole = shapes.NewShape() if len(parts) > 1 else None
    for part in parts:
        label = shapes.AddShape(part.shape, False)
        ocp.TDataStd.TDataStd_Name.Set_s(label, ocp.TCollection.TCollection_ExtendedString(_plain(part.name)))
        for called, shift in part.places.items() if whole is not None else ():
            move = ocp.gp.gp_Trsf()
            move.SetTranslation(ocp.gp.gp_Vec(*shift))
            placed = shapes.AddComponent(whole, label, ocp.TopLoc.TopLoc_Location(move))
            ocp.TDataStd.TDataStd_Name.Set_s(placed, ocp.TCollection.TCollection_ExtendedString(_plain(called)))
    if whole is not None:
        ocp.TDataStd.TDataStd_Name.Set_s(whole, ocp.TCollection.TCollection_ExtendedString(plain))
        shapes.UpdateAssemblies()
    writer = ocp.STEPCAFControl.STEPCAFControl_Writer()
    static = ocp.Interface.Interface_Static
    static.SetIVal_s("write.surfacecurve.mode", 0)  # surfaces imply these curves
    static.SetCVal_s("write.step.product.name", plain)
    writer.Transfer(document, ocp.STEPControl.STEPControl_AsIs)
    writer.Write(str(path))
    text = Path(path).read_text(encoding="utf-8")
    text = re.sub(r"FILE_NAME\('[^']*','[^']*'", f"FILE_NAME('{plain}','{release_date()}'", text, count=1)
    # Both count the exports of the process.
    text = re.sub(r"(STEP translator \d+\.\d+) \d+", r"\1", text)
    number = count(1)
    text = re.sub(r"(?<=NEXT_ASSEMBLY_USAGE_OCCURRENCE\(')\d+", lambda _: str(next(number)), text)
    Path(path).write_text(text, encoding="utf-8")


def _plain(name: str) -> str:
    return "".join(c if c.isascii() and (c.isalnum() or c in " -_.") else " " for c in name)


def release_date() -> str:
    """Date and time in written files, fixed for a release."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    when = datetime.fromtimestamp(int(seconds), UTC) if seconds.isdigit() else datetime(2026, 1, 1, tzinfo=UTC)
    return when.strftime("%Y-%m-%dT%H:%M:%S")


def _point(at: Array) -> Any:
    return ocp.gp.gp_Pnt(*at.tolist())


def _direction(way: Array) -> Any:
    return ocp.gp.gp_Dir(*way.tolist())


def _solid(solid: CurvedSolid) -> Any:
    corners = solid.body.corners
    vertices = [ocp.BRepBuilderAPI.BRepBuilderAPI_MakeVertex(_point(p)).Vertex() for p in corners]
    edges = {(a, b): _edge(corners, vertices, a, b, solid.arcs.get((a, b))) for a, b in solid.body.neighbours if a < b}
    builder = ocp.BRep.BRep_Builder()
    shell = ocp.TopoDS.TopoDS_Shell()
    builder.MakeShell(shell)
    for number, (face, normal) in enumerate(zip(solid.body.faces, solid.body.normals, strict=True)):
        curved = number in solid.curved
        made = _curved_face(solid, face, normal, edges) if curved else _flat_face(corners, face, normal, edges)
        builder.Add(shell, made)
    shell.Closed(True)
    whole = ocp.BRepBuilderAPI.BRepBuilderAPI_MakeSolid(shell).Solid()
    ocp.ShapeFix.ShapeFix_ShapeTolerance().SetTolerance(whole, _TOLERANCE)
    return whole


def _edge(corners: Array, vertices: list[Any], a: int, b: int, arc: Arc | None) -> Any:
    if arc is not None:
        return ocp.BRepBuilderAPI.BRepBuilderAPI_MakeEdge(_curve(corners, a, b, arc), vertices[a], vertices[b]).Edge()
    return ocp.BRepBuilderAPI.BRepBuilderAPI_MakeEdge(vertices[a], vertices[b]).Edge()


def _curve(corners: Array, a: int, b: int, arc: Arc) -> Any:
    return ocp.GC.GC_MakeArcOfCircle(
        *(ocp.gp.gp_Pnt(*map(float, p)) for p in (corners[a], arc.middle, corners[b]))
    ).Value()


def _wire(loop: tuple[int, ...], edges: dict[tuple[int, int], Any]) -> Any:
    builder = ocp.BRep.BRep_Builder()
    wire = ocp.TopoDS.TopoDS_Wire()
    builder.MakeWire(wire)
    for a, b in zip(loop, (*loop[1:], loop[0]), strict=True):
        builder.Add(wire, edges[a, b] if a < b else ocp.TopoDS.TopoDS.Edge_s(edges[b, a].Reversed()))
    wire.Closed(True)
    return wire


def _flat_face(corners: Array, face: Loops, normal: Array, edges: dict[tuple[int, int], Any]) -> Any:
    plane = ocp.gp.gp_Pln(_point(corners[face[0][0]]), _direction(normal))
    made = ocp.BRepBuilderAPI.BRepBuilderAPI_MakeFace(plane, _wire(face[0], edges), True)
    for hole in face[1:]:
        made.Add(_wire(hole, edges))
    return made.Face()


def _curved_face(solid: CurvedSolid, face: Loops, normal: Array, edges: dict[tuple[int, int], Any]) -> Any:
    loop = face[0]
    corners = solid.body.corners
    around = tuple(zip(loop, (*loop[1:], loop[0]), strict=True))
    both = [(a, b) for a, b in around if (min(a, b), max(a, b)) in solid.arcs]
    (a, b), (d, c) = sorted(both, key=lambda e: float(corners[e[0], 2]))
    one, two = (solid.arcs[min(e), max(e)] for e in ((a, b), (c, d)))
    low = float(corners[a, 2])
    rise = float(corners[c, 2]) - low
    wider = two.radius - one.radius
    outwards = np.array([*(np.array(one.middle[:2]) - one.centre), 0.0])
    seam = ocp.gp.gp_Dir(*-outwards)  # opposite of the arc
    axes = ocp.gp.gp_Ax3(ocp.gp.gp_Pnt(*one.centre, low), ocp.gp.gp_Dir(0.0, 0.0, 1.0), seam)
    if math.dist(one.centre, two.centre) > _SAME:
        surface = ocp.GeomFill.GeomFill.Surface_s(_curve(corners, a, b, one), _curve(corners, c, d, two))
        outwards = np.cross(corners[b] - corners[a], corners[c] - corners[a])
    elif abs(wider) < _SAME:
        surface = ocp.Geom.Geom_CylindricalSurface(axes, one.radius)
    else:
        surface = ocp.Geom.Geom_ConicalSurface(axes, math.atan2(wider, rise), one.radius)
    turned = normal @ outwards < 0.0
    made = ocp.TopoDS.TopoDS_Face()
    builder = ocp.BRep.BRep_Builder()
    builder.MakeFace(made, surface, _TOLERANCE)
    builder.Add(made, _wire(loop[::-1] if turned else loop, edges))
    for edge in map(ocp.TopoDS.TopoDS.Edge_s, parts_of(made, ocp.TopAbs.TopAbs_EDGE)):
        ocp.ShapeFix.ShapeFix_Edge().FixAddPCurve(edge, made, False, _TOLERANCE)
    return ocp.TopoDS.TopoDS.Face_s(made.Reversed()) if turned else made


def is_valid(part: StepPart) -> bool:
    """Whether a part is a solid without faults, by the kernel."""
    return _faultless(part.shape)


def _faultless(shape: Any) -> bool:
    return bool(ocp.BRepCheck.BRepCheck_Analyzer(shape).IsValid())


def read_step(path: str | os.PathLike[str]) -> StepSolid:
    """Measure the solid of a STEP file."""
    reader = ocp.STEPControl.STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    shape = reader.OneShape()
    volume = ocp.GProp.GProp_GProps()
    ocp.BRepGProp.BRepGProp.VolumeProperties_s(shape, volume)
    edges = map(ocp.TopoDS.TopoDS.Edge_s, parts_of(shape, ocp.TopAbs.TopAbs_EDGE))
    curves = [ocp.BRepAdaptor.BRepAdaptor_Curve(e) for e in edges]
    circles = [c.Circle() for c in curves if c.GetType() == ocp.GeomAbs.GeomAbs_Circle]
    return StepSolid(
        solids=len(parts_of(shape, ocp.TopAbs.TopAbs_SOLID)),
        valid=_faultless(shape),
        volume=float(volume.Mass()),
        corners=points_of(shape),
        circles=np.array([(*(c.Location().Coord()), c.Radius()) for c in circles]).reshape(-1, 4),
        shortest=min(float(ocp.GCPnts.GCPnts_AbscissaPoint.Length_s(c)) for c in curves),
    )
