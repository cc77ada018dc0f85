"""How much of the bent walls of a STEP file are cylinders and cones."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from plantar.shoes.solid.kernel import ocp, parts_of, points_of

_BULGE = 0.25  # mm between a facet's middle and the arc that it stands for


def bent_walls(path: Path) -> tuple[float, float]:
    """Areas in mm^2 of a STEP file's bent walls: of flat facets that bend at both ends, within 0.25 mm of an arc,
    and of cylinders and cones.
    """
    reader = ocp.STEPControl.STEPControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    shape = reader.OneShape()
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
            for i in (i for i in pair if long[i] * bend < 8.0 * _BULGE):
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
