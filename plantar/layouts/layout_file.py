"""The layout file: one JSON per sole, written by `shoes`."""

import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance
from plantar.common.atomic import write_text
from plantar.common.files.structured_text import read_json
from plantar.errors import LayoutError
from plantar.layouts.calibration import SoleCalibration
from plantar.layouts.layout import Side, SoleLayout
from plantar.layouts.source_pose import SourcePose

SCHEMA = "plantar.layout/1"
"""Schema name and version that a layout file states."""

_UNITS = "m, N, degC; sole frame: x forward, y left, z up, on the outer contact face"


def layout_to_dict(layout: SoleLayout) -> dict[str, Any]:
    """A layout as lossless plain JSON values, SI, sole frame."""
    instance(layout, SoleLayout, "layout")
    pose = {} if layout.pose is None else {"pose": layout.pose.as_dict()}
    known = {side: calibration.as_dict() for side, calibration in layout.calibrations.items()}
    calibrated = {"calibrations": known} if known else {}
    return {
        "schema": SCHEMA,
        "name": layout.name,
        "side": layout.side,
        "units": _UNITS,
        "cell_shape": layout.cell_shape,
        "cell_area": layout.cell_area,
        "modalities": list(layout.modalities),
        "ranges": {k: list(v) for k, v in layout.ranges.items()},
        "thresholds": dict(layout.thresholds),
        **({"noise": dict(layout.noise)} if layout.noise else {}),
        **pose,
        **calibrated,
        "outline": layout.outline.tolist(),
        "vertices": layout.vertices.tolist(),
        "taxels": [
            {
                "id": int(layout.ids[i]),
                "position": layout.positions[i].tolist(),
                "rotation_taxel_to_sole": layout.rotations[i].tolist(),
                "corners": list(layout.corners[i]),
                "area": float(layout.areas[i]),
                "neighbours": [int(layout.ids[j]) for j in layout.neighbours[i]],
            }
            for i in range(len(layout))
        ],
    }


def _take(source: Mapping[str, Any], key: str, kind: type | tuple[type, ...], where: str) -> Any:
    if key not in source:
        raise LayoutError(f"{where}: field '{key}' is missing")
    value = source[key]
    if isinstance(value, bool) or not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        raise LayoutError(
            f"{where}: field '{key}' is {type(value).__name__}; expected {' or '.join(k.__name__ for k in kinds)}"
        )
    return value


def _numbers(value: Any, shape: tuple[int | None, ...], field: str, where: str) -> Any:
    """Check that nested lists hold finite numbers in a shape; None is any."""
    if not shape:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise LayoutError(f"{where}: field '{field}' holds {type(value).__name__}; expected numbers")
        if not abs(value) <= sys.float_info.max:  # also large integers, which no float can hold
            raise LayoutError(f"{where}: field '{field}' holds a value that is not finite")
        return value
    if not isinstance(value, list) or shape[0] not in (None, len(value)):
        text = " x ".join("any" if s is None else str(s) for s in shape)
        raise LayoutError(f"{where}: field '{field}' is not a list of {text} numbers")
    for item in value:
        _numbers(item, shape[1:], field, where)
    return value


def layout_from_dict(source: Mapping[str, Any], where: str = "layout") -> SoleLayout:
    """A checked layout from plain JSON values."""
    if not isinstance(source, Mapping):
        raise LayoutError(f"{where}: not a JSON object")
    schema = _take(source, "schema", str, where)
    if schema != SCHEMA:
        raise LayoutError(f"{where}: field 'schema' is {schema!r}; this version reads {SCHEMA!r}")
    units = _take(source, "units", str, where) if "units" in source else _UNITS
    if units.partition(";")[0].replace(" ", "").split(",") != ["m", "N", "degC"]:
        raise LayoutError(f"{where}: field 'units' is {units[:60]!r}; allowed: m, N, degC")
    taxels = _take(source, "taxels", list, where)
    rows: dict[str, list[Any]] = {
        k: [] for k in ("id", "position", "rotation_taxel_to_sole", "corners", "area", "neighbours")
    }
    for i, taxel in enumerate(taxels):
        at = f"{where}: taxel {i}"
        if not isinstance(taxel, Mapping):
            raise LayoutError(f"{at} is not a JSON object")
        rows["id"].append(_take(taxel, "id", int, at))
        for key, shape in (("area", ()), ("position", (3,)), ("rotation_taxel_to_sole", (3, 3))):
            rows[key].append(_numbers(_take(taxel, key, (int, float, list), at), shape, key, at))
        for key in ("corners", "neighbours"):
            rows[key].append(_take(taxel, key, list, at))
            if not all(isinstance(v, int) and not isinstance(v, bool) for v in taxel[key]):
                raise LayoutError(f"{at}: field '{key}' holds a value that is not an integer")
    index = {v: i for i, v in enumerate(rows["id"])}
    try:
        neighbours = tuple(tuple(index[j] for j in near) for near in rows["neighbours"])
    except KeyError as missing:
        raise LayoutError(f"{where}: field 'neighbours' names taxel {missing}, which does not exist") from None
    ranges = _take(source, "ranges", dict, where)
    for key, value in ranges.items():
        _numbers(value, (2,), f"ranges.{key}", where)
    thresholds = _take(source, "thresholds", dict, where)
    for key, value in thresholds.items():
        _numbers(value, (), f"thresholds.{key}", where)
    noise = _take(source, "noise", dict, where) if "noise" in source else {}
    for key, value in noise.items():
        _numbers(value, (), f"noise.{key}", where)
    calibrations = _take(source, "calibrations", dict, where) if "calibrations" in source else {}
    vertices = _numbers(_take(source, "vertices", list, where), (None, 3), "vertices", where)
    outline = _numbers(_take(source, "outline", list, where), (None, 2), "outline", where)
    cell_area = _numbers(_take(source, "cell_area", (int, float), where), (), "cell_area", where)
    name, side, cell_shape = (_take(source, key, str, where) for key in ("name", "side", "cell_shape"))
    modalities = _take(source, "modalities", list, where)
    try:
        layout = SoleLayout(
            name=name,
            side=cast(Side, side),
            positions=np.array(rows["position"], dtype=np.float64),
            rotations=np.array(rows["rotation_taxel_to_sole"], dtype=np.float64),
            vertices=np.array(vertices, dtype=np.float64),
            corners=tuple(tuple(c) for c in rows["corners"]),
            neighbours=neighbours,
            areas=np.array(rows["area"], dtype=np.float64),
            outline=np.array(outline, dtype=np.float64),
            ids=np.array(rows["id"], dtype=np.int64),
            cell_shape=cell_shape,
            cell_area=float(cell_area),
            modalities=tuple(modalities),
            ranges={k: (float(v[0]), float(v[1])) for k, v in ranges.items()},
            thresholds={k: float(v) for k, v in thresholds.items()},
            noise={k: float(v) for k, v in noise.items()},
            calibrations={
                cast(Side, side): SoleCalibration.from_mapping(known, where) for side, known in calibrations.items()
            },
            pose=None if source.get("pose") is None else SourcePose.from_mapping(source["pose"], where),
        )
        check_cells(layout)
        return layout
    except LayoutError as error:
        raise LayoutError(f"{where}: {error}") from None
    except OverflowError:
        raise LayoutError(f"{where}: field 'id' holds an integer of more than 64 bits") from None


def read_layout(path: str | os.PathLike[str]) -> SoleLayout:
    """Read and check a layout file. Returns the layout.

    Args:
        path: A JSON file as of `write_layout`.

    Raises:
        LayoutError: If invalid; the message names file and field.

    Example:
        >>> import tempfile
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.05, 0.05), name="mat")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     len(read_layout(write_layout(layout, f"{folder}/mat.json")))
        8
    """
    file = instance(path, str | os.PathLike, "layout", LayoutError)
    return layout_from_dict(read_json(file, LayoutError, f"{path}:", "a JSON layout file"), where=str(path))


def write_layout(layout: SoleLayout, path: str | os.PathLike[str]) -> Path:
    """Write a layout file, whole or not at all; returns the path.

    Args:
        layout: The layout; LayoutError if `read_layout` would refuse it.
        path: Replaced if it exists.
    """
    check_cells(instance(layout, SoleLayout, "layout"))
    return write_text(path, json.dumps(layout_to_dict(layout), indent=1) + "\n")


_AREA = 0.1  # of a cell's area: round cells are written as polygons, curved ones seen from above
_OFF = 0.5  # of a cell's size: how far a taxel may be next to its own cell


def check_cells(layout: SoleLayout) -> None:
    """Refuse a layout with cells that contradict themselves."""
    import shapely

    if not len(layout):
        return
    facing = layout.rotations[:, 2, 2] <= 0.0
    if facing.any():
        raise LayoutError(f"field 'rotation_taxel_to_sole' of taxel {_first(layout, facing)} points out of the body")
    cells = np.array([shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))])
    crossed = ~shapely.is_valid(cells)
    if crossed.any():
        raise LayoutError(f"field 'corners' of taxel {_first(layout, crossed)} or 'vertices' makes a cell cross itself")
    turned = ~shapely.is_ccw(shapely.get_exterior_ring(cells))
    if turned.any():
        raise LayoutError(f"field 'corners' of taxel {_first(layout, turned)} goes round 'vertices' clockwise")
    # both from above
    seen = layout.areas * layout.rotations[:, 2, 2]
    flat = shapely.area(cells)
    wrong = np.abs(flat - seen) > _AREA * np.maximum(flat, seen)
    if wrong.any():
        i = int(np.flatnonzero(wrong)[0])
        stated = f"field 'area' of taxel {layout.ids[i]} is {layout.areas[i]:.3g} m^2"
        raise LayoutError(f"{stated}; its corners in 'vertices' enclose {flat[i]:.3g} m^2")
    off = shapely.distance(cells, shapely.points(layout.positions[:, :2])) > _OFF * np.sqrt(flat)
    if off.any():
        raise LayoutError(f"field 'position' of taxel {_first(layout, off)} lies beside its cell of 'vertices'")


def _first(layout: SoleLayout, mask: NDArray[np.bool_]) -> int:
    return int(layout.ids[np.flatnonzero(mask)[0]])
