"""Meshes that trimesh reads, in a separate process (`plantar.common.files.gate`)."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.xml_file import parse_xml
from plantar.common.optional_library import optional_library
from plantar.errors import DependencyError, PlantarError


def triangles_of_listed(path: Path) -> dict[str, NDArray[Any]]:
    """Triangles (n, 3, 3) in file units of each mesh file that a JSON list at a path names, by its number there; none
    of one that cannot be read.
    """
    found = {}
    for i, name in enumerate(json.loads(path.read_bytes())):
        try:
            found[str(i)] = triangles_of_trimesh(Path(name))["triangles"]
        except DependencyError:
            raise
        except Exception:  # of every kind on a damaged file
            found[str(i)] = np.empty((0, 3, 3))
    return found


def triangles_of_trimesh(path: Path) -> dict[str, NDArray[Any]]:
    """Triangles (n, 3, 3) of the mesh file at a path, as "triangles": in file units; of COLLADA in m, its up axis
    ignored as in RViz and Gazebo (github.com/ros-visualization/rviz/issues/1045).
    """
    if path.suffix.lower() == ".dae":
        parse_xml(path.read_bytes(), PlantarError, str(path))
    with optional_library("trimesh", "shoes"):
        import trimesh
    with np.errstate(all="ignore"):  # coordinates that are not finite are refused later
        mesh = trimesh.load(path, process=False, force="mesh", skip_materials=True)
    if not isinstance(mesh, trimesh.Trimesh):
        return {"triangles": np.empty((0, 3, 3))}
    triangles = np.asarray(mesh.vertices, dtype=float)[np.asarray(mesh.faces, dtype=np.int64)]
    if path.suffix.lower() == ".dae":
        triangles *= float(str(mesh.units).partition("*")[0]) if "*" in str(mesh.units) else 1.0  # "0.001 * meters"
    return {"triangles": triangles}
