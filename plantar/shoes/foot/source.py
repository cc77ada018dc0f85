"""Foot sources: mesh, robot model, drawing, built-in robot, or dimensions."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from plantar.common.files.input_file import check_input
from plantar.common.files.structured_text import packaged_files, read_toml
from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import FootError, InputError, RobotError
from plantar.layouts.source_pose import SourcePose
from plantar.shoes.foot.foot import Foot, foot_from_dimensions
from plantar.shoes.foot.foot_mesh import foot_from_mesh, foot_from_triangles
from plantar.shoes.foot.mesh_file import MESH_FORMATS
from plantar.shoes.foot.outline_file import OUTLINE_FORMATS, foot_from_drawing
from plantar.shoes.foot.robot_model import MODEL_FORMATS, BodyGeometry, read_foot_body, side_of_name
from plantar.shoes.foot.shank import shank_links, stated_shank
from plantar.shoes.order import FootSource

_ALLOWED = {
    "mesh_side": SIDES,
    "unit": ("m", "cm", "mm", "in"),
    "up": ("x", "-x", "y", "-y", "z", "-z"),
    "forward": ("x", "-x", "y", "-y"),
}

_SHANK_TOP = 60.0  # mm up to which a stated shank does not lean

_ASSUMED = "taken to be a left foot: no name shows the side (or give --mesh-side right)"


def read_foot(source: FootSource, *, sole_band: float) -> tuple[Foot, int | None]:
    """Gives left foot of a source, sole_band in mm a mesh's sole height, and a robot file's taxel count, or None.

    Raises:
        InputError: If options conflict.
        FootError: If no foot.
        RobotError: If its file is unusable.

    Example:
        >>> foot, taxels = read_foot(FootSource(dimensions="240x95"), sole_band=5.0)
        >>> foot.name, taxels
        ('foot', None)
    """
    if sum(v is not None for v in (source.file, source.robot, source.dimensions)) != 1:
        raise InputError(
            "give one of: a file of the foot (plantar shoe FOOT.stl), --robot NAME, or --dimensions LENGTHxWIDTH"
        )
    for name, allowed in _ALLOWED.items():
        value = getattr(source, name)
        if value is not None and value not in allowed:
            raise InputError(f"--{name.replace('_', '-')} is '{value}'; allowed: {', '.join(allowed)}")
    if source.file is None:
        for name in ("body", "sole_z", "up", "forward", "unit", "mesh_side"):
            if getattr(source, name) is not None:
                given = "--robot" if source.robot is not None else "--dimensions"
                raise InputError(f"--{name.replace('_', '-')} is for a file of the foot; {given} needs none")
    taxels = None
    if source.robot is not None:
        foot, taxels = foot_of_robot(source.robot)
    elif source.dimensions is not None:
        foot = _box_foot(source.dimensions)
    else:
        foot = _foot_of_file(cast(Path, source.file), source, sole_band)
    return _with_shank(foot, source.shank), taxels


def _with_shank(foot: Foot, text: str | None) -> Foot:
    """A foot with a stated shank, from above the sole on."""
    if text is None:
        return foot
    shank = stated_shank(text)
    if foot.links is not None and not foot.unread:
        raise InputError("--shank is for a foot alone; the robot's model shows where its links pass")
    links = shank_links(shank, shank, min(foot.height, _SHANK_TOP))
    if foot.links is not None:
        links = np.concatenate([foot.links, links])
    return replace(
        foot, links=links, unread=(), notes=(*foot.notes, f"the shank passes where --shank states it: {text}")
    )


def _foot_of_file(path: Path, source: FootSource, sole_band: float) -> Foot:
    kind = path.suffix.lower()
    if kind not in (*MESH_FORMATS, *MODEL_FORMATS, *OUTLINE_FORMATS):
        check_input(path, FootError)  # a wrong path is given as such, no matter what it ends in
        meshes, models, outlines = (", ".join(kinds) for kinds in (MESH_FORMATS, MODEL_FORMATS, OUTLINE_FORMATS))
        raise FootError(
            f"{path}: a foot is not read from '{kind or path.name}'; allowed: a mesh ({meshes}), a robot's model with "
            f"--body ({models}), the outline of a sole ({outlines})"
        )
    named = source.mesh_side or side_of_name(re.sub(r"(?i)r\d+", " ", path.stem))  # a foot_r2 is no right one
    assumed = () if named else (_ASSUMED,)
    side = cast(Any, named or "left")
    options: dict[str, Any] = {"unit": source.unit, "forward": source.forward}
    if kind in OUTLINE_FORMATS:
        for option, value in (("--body", source.body), ("--sole-z", source.sole_z), ("--up", source.up)):
            if value is not None:
                raise InputError(f"{option} is for meshes and models; {path} is the outline of a sole")
        foot = foot_from_drawing(path, mesh_side=side, **options)
        return replace(foot, notes=(*foot.notes, *assumed))
    options |= {"up": source.up, "sole_z": source.sole_z, "sole_band": sole_band}
    if kind in MODEL_FORMATS:
        found = read_foot_body(path, source.body, options["unit"])
        named = source.mesh_side or found.side
        where = f"{path}, body '{source.body}'"
        options |= {"file_unit": "m", "mesh_side": named or "left", "links": found.links, "link": found.link}
        foot = foot_from_triangles(path.stem, found.triangles, where=where, **options)
        notes = (*found.notes, *foot.notes, *(() if named else (_ASSUMED,)))
        return replace(foot, mass=found.mass, notes=notes, unread=found.unread, poses=_poses_of_both(foot, found))
    if source.body is not None:
        raise InputError(f"--body is for a robot's model ({', '.join(MODEL_FORMATS)}); {path} is none")
    foot = foot_from_mesh(path, mesh_side=side, **options)
    return replace(foot, notes=(*foot.notes, *assumed))


def _poses_of_both(foot: Foot, found: BodyGeometry) -> dict[Side, SourcePose]:
    """Poses of the sole that was read, and of the other foot's where the robot is its own mirror image."""
    poses = dict(foot.poses)
    (side, pose), *_ = poses.items()
    if found.other is not None and found.link is not None:
        poses[other_side(side)] = found.other.pose(pose, found.link)
    return poses


def _box_foot(text: str) -> Foot:
    try:
        values = [float(v) / 1000.0 for v in text.lower().split("x")]
    except ValueError:
        values = []
    if len(values) not in (2, 3):
        raise InputError(f"--dimensions is '{text}'; allowed: LENGTHxWIDTH or LENGTHxWIDTHxRADIUS in mm, as 241x138x20")
    if 0.0 < values[0] < values[1]:
        raise InputError(f"--dimensions is '{text}', wider than long; allowed: LENGTHxWIDTH in mm, as 241x138")
    radius = values[2] if len(values) == 3 else min(0.010, 0.25 * abs(values[1]))
    return foot_from_dimensions("foot", length=values[0], width=values[1], corner_radius=radius)


def foot_of_robot(name: str) -> tuple[Foot, int | None]:
    """Left foot of a built-in robot and its taxel count or None, without loading the simulator.

    Raises:
        InputError: If unknown; lists all robots.
        RobotError: If its file is unusable.

    Example:
        >>> foot_of_robot("h1")[1]
        42
    """
    files = {path.parent.name: path for path in packaged_files("plantar.robots", "*/robot.toml")}
    if name not in files:
        raise InputError(f"unknown robot '{name}'; allowed: {', '.join(sorted(files))}")
    try:
        source = read_toml(files[name], RobotError, f"robot file {files[name]}")
        facts = source["foot"]
        mass = source.get("biped", {}).get("total_mass")
        foot = foot_from_dimensions(
            name,
            length=float(facts["foot_length"]),
            width=float(facts["foot_width"]),
            sole_center=(float(facts["sole_center"][0]), float(facts["sole_center"][1])),
            corner_radius=float(facts["corner_radius"]),
            mass=None if mass is None else float(mass),
        )
        taxels = facts.get("taxels")
    except (ValueError, LookupError, TypeError) as error:
        raise RobotError(f"{files[name]}: table [foot] cannot be used ({error!r})") from None
    return foot, None if taxels is None else int(taxels)
