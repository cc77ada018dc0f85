"""STEP and IGES files through OpenCascade, called in a process apart; cadquery would take twice the time and memory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.optional_library import optional_library

__all__ = ["triangles_of_step"]

_CHORD, _ANGLE = 0.05, 0.2  # share of an edge, and rad: how far triangles may lie off a curved face


def triangles_of_step(path: Path) -> dict[str, NDArray[Any]]:
    """Triangles (n, 3, 3) in mm of all shapes of a STEP or IGES file, as "triangles".

    Raises:
        DependencyError: If OpenCascade is not installed.
        ValueError: If the file cannot be read.
    """
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
        face, place = TopoDS.Face_s(faces.Current()), TopLoc_Location()
        faces.Next()
        mesh = BRep_Tool.Triangulation_s(face, place)
        if mesh is None:
            continue
        move = place.Transformation()
        nodes = (mesh.Node(i).Transformed(move) for i in range(1, mesh.NbNodes() + 1))
        points = np.array([(p.X(), p.Y(), p.Z()) for p in nodes])
        corners = np.array([(t.Value(1), t.Value(2), t.Value(3)) for t in mesh.Triangles()], dtype=np.int64) - 1
        if len(corners):
            turned = corners[:, [0, 2, 1]] if face.Orientation() == TopAbs_REVERSED else corners
            out.append(points[turned])
    return out
