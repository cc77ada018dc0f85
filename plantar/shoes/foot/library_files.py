"""Foot files read by libraries in a separate process (`plantar.common.files.confined`): solids, DXF."""

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library

# share of an edge, and rad: how far triangles may lie off a curved face
_CHORD = 0.05
_ANGLE = 0.2


def triangles_of_step(path: Path) -> dict[str, NDArray[Any]]:
    """Triangles (n, 3, 3) in mm of all STEP or IGES shapes, as "triangles"."""
    with optional_library("OCP", "shoes"):
        from OCP.BRepMesh import BRepMesh_IncrementalMesh
        from OCP.IFSelect import IFSelect_RetDone
        from OCP.IGESControl import IGESControl_Reader
        from OCP.Interface import Interface_Static
        from OCP.STEPControl import STEPControl_Reader
    reader = IGESControl_Reader() if path.suffix.lower() in (".iges", ".igs") else STEPControl_Reader()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    if reader.ReadFile(str(path)) != IFSelect_RetDone:
        raise ValueError("OpenCascade finds no shapes in it")
    reader.TransferRoots()
    parts = [np.empty((0, 3, 3))]
    for i in range(reader.NbShapes()):
        shape = reader.Shape(i + 1)
        if not shape.IsNull():
            BRepMesh_IncrementalMesh(shape, _CHORD, True, _ANGLE, False)
            parts += _triangles(shape)
    return {"triangles": np.concatenate(parts)}


def _triangles(shape: Any) -> list[NDArray[np.float64]]:
    from OCP.BRep import BRep_Tool
    from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    out = []
    faces = TopExp_Explorer(shape, TopAbs_FACE)
    while faces.More():
        face = TopoDS.Face_s(faces.Current())
        place = TopLoc_Location()
        faces.Next()
        mesh = BRep_Tool.Triangulation_s(face, place)
        if mesh is None:
            continue
        move = place.Transformation()
        nodes = (mesh.Node(i).Transformed(move) for i in range(1, mesh.NbNodes() + 1))
        points = np.array([(p.X(), p.Y(), p.Z()) for p in nodes])
        corners = np.array([(t.Value(1), t.Value(2), t.Value(3)) for t in mesh.Triangles()], dtype=np.int64) - 1
        if len(corners):
            out.append(points[corners[:, [0, 2, 1]] if face.Orientation() == TopAbs_REVERSED else corners])
    return out


_FINE = 0.002  # of the drawing's size: how far a curve's chord may lie from it


def lines_of_dxf(path: Path) -> dict[str, NDArray[Any]]:
    """Lines of a DXF's model space, blocks expanded: all "points" (n, 2), y upwards; "counts" (k,) of each; "unit", its
    $INSUNITS.
    """
    with optional_library("ezdxf", "shoes"):
        from ezdxf import path as paths
        from ezdxf import recover
        from ezdxf.disassemble import recursive_decompose
        from ezdxf.lldxf.const import DXFError
    document, _ = recover.read(io.BytesIO(path.read_bytes()))
    found = []
    hidden = {layer.dxf.name.lower() for layer in document.layers if layer.is_off() or layer.is_frozen()}
    for entity in recursive_decompose(document.modelspace()):
        if entity.dxf.get("layer", "0").lower() in hidden:
            continue
        try:
            found.append(paths.make_path(entity))
        except (TypeError, DXFError):
            continue  # texts, dimensions, hatches: no line
    found = [p for p in found if len(p)]
    rough = np.array([(v.x, v.y) for p in found for v in p.control_vertices()]).reshape(-1, 2)
    fine = _FINE * float(np.ptp(rough, axis=0).max()) if len(rough) else 1.0
    if not 0.0 < fine < np.inf:
        raise ValueError("its coordinates are not finite, or all the same")
    lines = [[(v.x, v.y) for v in p.flattening(fine)] for p in found]
    return {
        "points": np.array([point for line in lines for point in line]).reshape(-1, 2),
        "counts": np.array([len(line) for line in lines], dtype=np.int64),
        "unit": np.array(int(document.header.get("$INSUNITS", 0))),
    }
