"""DXF drawings through ezdxf, called in a process apart (`plantar.files.confined`)."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.optional_library import optional_library

__all__ = ["lines_of_dxf"]

_FINE = 0.002  # of the drawing's size: how far a curve's chord may lie from it


def lines_of_dxf(path: Path) -> dict[str, NDArray[Any]]:
    """Lines of a DXF's model space, blocks expanded: "points" (n, 2) of all, y upwards; "counts" (k,) of each; "unit",
    its $INSUNITS.
    """
    with optional_library("ezdxf", "shoes"):
        from ezdxf import path as paths
        from ezdxf import recover
        from ezdxf.disassemble import recursive_decompose
        from ezdxf.lldxf.const import DXFError
    document, _ = recover.read(io.BytesIO(path.read_bytes()))
    found = []
    for entity in recursive_decompose(document.modelspace()):
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
