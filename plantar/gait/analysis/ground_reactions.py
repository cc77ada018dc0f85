"""Forces of the ground on each foot, for exports: force, centre of pressure, free moment; and OpenSim files of them.

OpenSim's ground has x ahead, y up and z to the right: (x, y, z) of here is its (x, z, -y).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.gait.analysis.results import Analysis
from plantar.sides import Side

__all__ = ["GroundReaction", "ground_reactions", "write_external_loads", "write_mot"]


class GroundReaction(NamedTuple):
    """The ground's reaction on one foot.

    Attributes:
        force: Force (n, 3) in N; horizontal parts 0 where they were not measured.
        cop: Its point (n, 2) in m, 0 without load.
        free: Free moment (n,) about the vertical there in N m.
    """

    force: NDArray[np.float64]
    cop: NDArray[np.float64]
    free: NDArray[np.float64]


def ground_reactions(analysis: Analysis) -> dict[Side, GroundReaction]:
    """The ground's force on each foot, in the laboratory's axes of plates, in the sole frame of insoles and robots."""
    out: dict[Side, GroundReaction] = {}
    for side, gait in analysis.feet.items():
        foot = gait.foot
        vertical = np.nan_to_num(foot.vertical_force)
        force = np.column_stack([np.zeros((len(vertical), 2)), vertical])
        free = np.zeros(len(vertical))
        known = foot.center_of_pressure(1e-6)
        cop = np.zeros((len(vertical), 2)) if known is None else np.nan_to_num(known)
        if foot.wrench is not None:
            wrench = np.nan_to_num(foot.wrench)
            force[:, :2] = wrench[:, :2]
            free = wrench[:, 5] - cop[:, 0] * force[:, 1] + cop[:, 1] * force[:, 0]
        out[side] = GroundReaction(force, cop, free)
    return out


def write_mot(analysis: Analysis, path: Path) -> None:
    """Write the ground's forces of an analysis to a motion file (.mot) of OpenSim at a path; InputError of raw
    counts.
    """
    if analysis.recording.raw:
        raise InputError("a recording of raw counts has no forces for OpenSim; allowed: npz, csv, c3d")
    names, columns = ["time"], [analysis.recording.time]
    for side, reaction in ground_reactions(analysis).items():
        x, y = reaction.cop.T
        zero = np.zeros(len(x))
        parts: Mapping[str, tuple[NDArray[np.float64], ...]] = {
            "force_{}_v": (reaction.force[:, 0], reaction.force[:, 2], -reaction.force[:, 1]),
            "force_{}_p": (x, zero, -y),
            "torque_{}_": (zero, reaction.free, zero),
        }
        for name, three in parts.items():
            names += [f"ground_{name.format(side)}{axis}" for axis in "xyz"]
            columns += three
    head = f"{path.stem}\nversion=1\nnRows={len(columns[0])}\nnColumns={len(names)}\ninDegrees=no\nendheader\n"
    with path.open("w", encoding="utf-8") as stream:
        stream.write(head + "\t".join(names) + "\n")
        for row in np.column_stack(columns).tolist():
            stream.write("\t".join(f"{v:.10g}" for v in row) + "\n")


def write_external_loads(analysis: Analysis, path: Path, motion: str) -> None:
    """Write OpenSim's description (.xml) of which columns of a motion file act on which body.

    Args:
        analysis: The analysis.
        path: The file.
        motion: Name of the motion file, next to it.
    """
    root = ElementTree.Element("OpenSimDocument", Version="40000")
    loads = ElementTree.SubElement(root, "ExternalLoads", name="externalloads")
    objects = ElementTree.SubElement(loads, "objects")
    plates = analysis.recording.kind == "plate"
    for side in analysis.feet:
        body = f"calcn_{side[0]}"
        one = ElementTree.SubElement(objects, "ExternalForce", name=f"ground_{side}")
        for key, value in (
            ("applied_to_body", body),
            ("force_expressed_in_body", "ground"),
            ("point_expressed_in_body", "ground" if plates else body),
            ("force_identifier", f"ground_force_{side}_v"),
            ("point_identifier", f"ground_force_{side}_p"),
            ("torque_identifier", f"ground_torque_{side}_"),
            ("data_source_name", motion),
        ):
            ElementTree.SubElement(one, key).text = value
    ElementTree.SubElement(loads, "datafile").text = motion
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
