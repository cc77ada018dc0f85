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

from plantar.shoes.solid.arcs import BULGE, Arc, CurvedSolid, with_arcs
from plantar.shoes.solid.kernel import ocp, parts_of, points_of
from plantar.shoes.solid.polyhedron import Loops, Polyhedron

__all__ = ["StepPart", "StepSolid", "read_step", "release_date", "with_shared_entities", "write_step"]

_TOLERANCE = 1e-5  # mm
_SAME = 1e-6  # mm between the centres of a cone's two arcs

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StepPart:
    """Part of an assembly.

    Attributes:
        name: Of the product.
        places: Shifts (3,) in mm by instance name.
    """

    name: str
    body: Polyhedron
    places: Mapping[str, tuple[float, float, float]]

    @cached_property
    def shape(self) -> Any:
        """Kernel solid, with arcs."""
        return _solid(with_arcs(self.body))


@dataclass(frozen=True)
class StepSolid:
    """Solid of a STEP file.

    Attributes:
        valid: Without faults, by the kernel.
        volume: In mm^3.
        corners: Points (n, 3).
        circles: Arc centre and radius (m, 4).
        shortest: Shortest edge.
        flat: Area in mm^2 of bent walls' flat facets, bent at both ends, within `BULGE` of an arc.
        round: Area of cylinders and cones.
    """

    solids: int
    valid: bool
    volume: float
    corners: Array
    circles: Array
    shortest: float
    flat: float
    round: float


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
    text, number = re.sub(r"(STEP translator \d+\.\d+) \d+", r"\1", text), count(1)
    text = re.sub(r"(?<=NEXT_ASSEMBLY_USAGE_OCCURRENCE\(')\d+", lambda _: str(next(number)), text)
    Path(path).write_text(with_shared_entities(text), encoding="utf-8")


def _plain(name: str) -> str:
    return "".join(c if c.isascii() and (c.isalnum() or c in " -_.") else " " for c in name)


def release_date() -> str:
    """Date and time in written files, fixed for a release."""
    seconds = os.environ.get("SOURCE_DATE_EPOCH", "")
    when = datetime.fromtimestamp(int(seconds), UTC) if seconds.isdigit() else datetime(2026, 1, 1, tzinfo=UTC)
    return when.strftime("%Y-%m-%dT%H:%M:%S")


def _solid(solid: CurvedSolid) -> Any:
    vertices = [
        ocp.BRepBuilderAPI.BRepBuilderAPI_MakeVertex(ocp.gp.gp_Pnt(*p)).Vertex() for p in solid.body.corners.tolist()
    ]
    edges = {
        (a, b): _edge(solid.body.corners, vertices, a, b, solid.arcs.get((a, b)))
        for a, b in solid.body.neighbours
        if a < b
    }
    builder, shell = ocp.BRep.BRep_Builder(), ocp.TopoDS.TopoDS_Shell()
    builder.MakeShell(shell)
    for number, face in enumerate(solid.body.faces):
        curved = number in solid.curved
        made = (_curved_face if curved else _flat_face)(solid, face, solid.body.normals[number], edges)
        builder.Add(shell, made)
    shell.Closed(True)
    whole = ocp.BRepBuilderAPI.BRepBuilderAPI_MakeSolid(shell).Solid()
    ocp.ShapeFix.ShapeFix_ShapeTolerance().SetTolerance(whole, _TOLERANCE)
    return whole


def _edge(corners: Array, vertices: list[Any], a: int, b: int, arc: Arc | None) -> Any:
    if arc is None:
        return ocp.BRepBuilderAPI.BRepBuilderAPI_MakeEdge(vertices[a], vertices[b]).Edge()
    return ocp.BRepBuilderAPI.BRepBuilderAPI_MakeEdge(_curve(corners, a, b, arc), vertices[a], vertices[b]).Edge()


def _curve(corners: Array, a: int, b: int, arc: Arc) -> Any:
    return ocp.GC.GC_MakeArcOfCircle(
        *(ocp.gp.gp_Pnt(*map(float, p)) for p in (corners[a], arc.middle, corners[b]))
    ).Value()


def _wire(loop: tuple[int, ...], edges: dict[tuple[int, int], Any]) -> Any:
    builder, wire = ocp.BRep.BRep_Builder(), ocp.TopoDS.TopoDS_Wire()
    builder.MakeWire(wire)
    for a, b in zip(loop, (*loop[1:], loop[0]), strict=True):
        builder.Add(wire, edges[a, b] if a < b else ocp.TopoDS.TopoDS.Edge_s(edges[b, a].Reversed()))
    wire.Closed(True)
    return wire


def _flat_face(solid: CurvedSolid, face: Loops, normal: Array, edges: dict[tuple[int, int], Any]) -> Any:
    plane = ocp.gp.gp_Pln(
        ocp.gp.gp_Pnt(*solid.body.corners[list(face[0])].mean(axis=0).tolist()), ocp.gp.gp_Dir(*normal.tolist())
    )
    made = ocp.BRepBuilderAPI.BRepBuilderAPI_MakeFace(plane, _wire(face[0], edges), True)
    for hole in face[1:]:
        made.Add(_wire(hole, edges))
    return made.Face()


def _curved_face(solid: CurvedSolid, face: Loops, normal: Array, edges: dict[tuple[int, int], Any]) -> Any:
    loop, corners = face[0], solid.body.corners
    around = tuple(zip(loop, (*loop[1:], loop[0]), strict=True))
    both = [(a, b) for a, b in around if (min(a, b), max(a, b)) in solid.arcs]
    (a, b), (d, c) = sorted(both, key=lambda e: float(corners[e[0], 2]))
    one, two = (solid.arcs[min(e), max(e)] for e in ((a, b), (c, d)))
    low = float(corners[a, 2])
    rise, wider = float(corners[c, 2]) - low, two.radius - one.radius
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
    made, builder = ocp.TopoDS.TopoDS_Face(), ocp.BRep.BRep_Builder()
    builder.MakeFace(made, surface, _TOLERANCE)
    builder.Add(made, _wire(loop[::-1] if turned else loop, edges))
    for edge in map(ocp.TopoDS.TopoDS.Edge_s, parts_of(made, ocp.TopAbs.TopAbs_EDGE)):
        ocp.ShapeFix.ShapeFix_Edge().FixAddPCurve(edge, made, False, _TOLERANCE)
    return ocp.TopoDS.TopoDS.Face_s(made.Reversed()) if turned else made


def read_step(path: str | os.PathLike[str]) -> StepSolid:
    """Measure the solid of a STEP file."""
    reader = ocp.STEPControl.STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    shape, volume = reader.OneShape(), ocp.GProp.GProp_GProps()
    ocp.BRepGProp.BRepGProp.VolumeProperties_s(shape, volume)
    edges = map(ocp.TopoDS.TopoDS.Edge_s, parts_of(shape, ocp.TopAbs.TopAbs_EDGE))
    curves = [ocp.BRepAdaptor.BRepAdaptor_Curve(e) for e in edges]
    circles = [c.Circle() for c in curves if c.GetType() == ocp.GeomAbs.GeomAbs_Circle]
    flat, bent = _bent_walls(shape)
    return StepSolid(
        solids=len(parts_of(shape, ocp.TopAbs.TopAbs_SOLID)),
        valid=bool(ocp.BRepCheck.BRepCheck_Analyzer(shape).IsValid()),
        volume=float(volume.Mass()),
        corners=points_of(shape),
        circles=np.array([(*(c.Location().Coord()), c.Radius()) for c in circles]).reshape(-1, 4),
        shortest=min(float(ocp.GCPnts.GCPnts_AbscissaPoint.Length_s(c)) for c in curves),
        flat=flat,
        round=bent,
    )


def _bent_walls(shape: Any) -> tuple[float, float]:
    faces = [ocp.TopoDS.TopoDS.Face_s(f) for f in parts_of(shape, ocp.TopAbs.TopAbs_FACE)]
    surfaces = [ocp.BRepAdaptor.BRepAdaptor_Surface(f) for f in faces]
    bends: list[set[tuple[float, ...]]] = [set() for _ in faces]  # where, in plan: a facet has two ends
    normals = np.zeros((len(faces), 3))
    long = np.zeros(len(faces))
    edges = ocp.TopTools.TopTools_IndexedMapOfShape()
    ocp.TopExp.TopExp.MapShapes_s(shape, ocp.TopAbs.TopAbs_EDGE, edges)
    owners: list[list[int]] = [[] for _ in range(edges.Size())]
    for i, (face, surface) in enumerate(zip(faces, surfaces, strict=True)):
        if surface.GetType() == ocp.GeomAbs.GeomAbs_Plane:
            normals[i] = surface.Plane().Axis().Direction().Coord()
            if abs(normals[i, 2]) < 1e-6:
                long[i] = math.hypot(*np.ptp(points_of(face)[:, :2], axis=0))
                for edge in parts_of(face, ocp.TopAbs.TopAbs_EDGE):
                    owners[edges.FindIndex(edge) - 1].append(i)
    for k, pair in ((k, p) for k, p in enumerate(owners, start=1) if len(p) == 2):
        bend = math.acos(min(1.0, abs(float(normals[pair[0]] @ normals[pair[1]]))))
        if math.radians(1.0) < bend < math.radians(20.0):
            for i in (i for i in pair if long[i] * bend < 8.0 * BULGE):
                bends[i].add(tuple(points_of(edges.FindKey(k))[0, :2].round(3).tolist()))

    def area(numbers: Any) -> float:
        total = 0.0
        for i in numbers:
            measured = ocp.GProp.GProp_GProps()
            ocp.BRepGProp.BRepGProp.SurfaceProperties_s(faces[i], measured)
            total += float(measured.Mass())
        return total

    bent = [
        i for i, s in enumerate(surfaces) if s.GetType() in (ocp.GeomAbs.GeomAbs_Cylinder, ocp.GeomAbs.GeomAbs_Cone)
    ]
    # A facet that is bent at one end alone is at a corner of a polygon.
    return area(i for i, places in enumerate(bends) if len(places) > 1), area(bent)


_REFERENCE = re.compile(r"('[^']*')|#(\d+)")
_SHARED = ("CARTESIAN_POINT", "DIRECTION", "VECTOR", "AXIS2_PLACEMENT_3D", "LINE", "CIRCLE")  # each of those before


def with_shared_entities(text: str) -> str:
    """Shorten a file to about two thirds; topology stays as it is.

    Example:
        >>> data = "DATA;\\n#1 = DIRECTION('',(1.));\\n#2 = DIRECTION('',(1.));\\n#3 = PLANE('#2',#1,#2);\\nENDSEC;\\n"
        >>> with_shared_entities(data)
        "DATA;\\n#1=DIRECTION('',(1.));\\n#2=PLANE('#2',#1,#1);\\nENDSEC;\\n"
    """
    begin = text.index("DATA;\n") + len("DATA;\n")
    end = text.index("\nENDSEC;", begin)
    start, data, tail = text[:begin], text[begin:end], text[end + 1 :]
    entities = []
    for line in data.removesuffix(";").split(";\n"):
        number, _, body = re.sub(r"\n *", "", line).removeprefix("#").partition(" = ")
        entities.append((number, body))
    stands = {number: number for number, _ in entities}

    def referring(body: str, numbers: dict[str, str]) -> str:
        return _REFERENCE.sub(lambda r: r[1] or "#" + numbers[r[2]], body)

    for kind in _SHARED:
        first: dict[str, str] = {}
        for number, body in entities:
            if body.startswith(kind + "("):
                stands[number] = first.setdefault(referring(body, stands), number)
    kept = [(number, body) for number, body in entities if stands[number] == number]
    place = {number: str(i) for i, (number, _) in enumerate(kept, start=1)}
    numbers = {number: place[other] for number, other in stands.items()}
    lines = [f"#{place[number]}={referring(body, numbers)};" for number, body in kept]
    return start + "\n".join(lines) + "\n" + tail
