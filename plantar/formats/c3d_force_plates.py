"""Force plates in C3D files: force, moment and CoP, without cells.

Types 1 to 5 are computed from channels (C3D format user guide, "Force platforms").
"""

import struct
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.input_file import check_input, open_input
from plantar.common.sides import SIDES, Side
from plantar.errors import DependencyError, FormatError
from plantar.formats.force_plates import feet_of_plates
from plantar.formats.format import Format, ReadOptions
from plantar.formats.plate_sides import Plate
from plantar.formats.plausibility import possible
from plantar.formats.units import FORCES, LENGTHS, MOMENTS, plain
from plantar.recordings.pressure_recording import PressureRecording, StatedEvents, possible_rate

# bytes
_LARGEST = 256e6
_HEAD = 1 << 16
_TILT = 0.97  # Least cosine of the angle between a plate's normal and the laboratory's vertical: 14 degrees, a ramp
_LONGEST_PLATE = 2.0  # Largest distance in m of a CoP from where a plate's moments are about
_KILONEWTONS = (0.15, 5.0)  # Largest forces of a person in kN
_LARGEST_TURN = 0.1  # Largest free moment in N m for each N of vertical force
_INTEL, _DEC, _MIPS = 84, 85, 86  # Processors by the byte that names them
# The laboratory's axes in the order that makes its vertical one the third, right-handed.
_TO_Z_UP = {0: [1, 2, 0], 1: [2, 0, 1], 2: [0, 1, 2]}


def _recognises(head: bytes) -> bool:
    if len(head) < 1024 or head[1] != 0x50 or not 2 <= head[0] <= 100:
        return False
    return _processor(head) in (_INTEL, _DEC, _MIPS)


def _processor(head: bytes) -> int:
    place = (head[0] - 1) * 512 + 3  # in the head of the parameters
    return head[place] if place < len(head) else 0


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    if find_spec("ezc3d") is None:
        raise DependencyError("ezc3d", "formats")
    check_input(path, FormatError, _LARGEST)
    with open_input(path, FormatError) as stream:
        head = stream.read(_HEAD)
    if len(head) < 512 or head[1] != 0x50:
        raise FormatError("not a C3D file that can be read (no C3D header)")
    if _processor(head) == _MIPS:
        raise FormatError("written for an SGI (MIPS) processor; allowed: the same file saved for Intel or DEC")
    held = read_apart("c3d", path, FormatError)
    rate = options.rate_hz or float(held["rate"])
    count = int(held["plates"])
    if count == 0:
        raise FormatError("the C3D file holds no force plate (group FORCE_PLATFORM)")
    if not held["frames"]:
        raise FormatError("the C3D file names force plates, and its analog channels hold no samples")
    possible_rate(rate, "its analog channels state")
    warnings = _cut_short(head, held)
    length = LENGTHS.get(plain(str(held["point_unit"][0])), 1e-3)
    up = _vertical_axis([held[f"corners_{i}"] for i in range(count)], warnings)
    plates = [_plate(held, i, up, length, options.unit, warnings) for i in range(count)]
    markers = {s: length * held[f"track_{s}"][:, _TO_Z_UP[up]][:, :2] for s in SIDES if f"track_{s}" in held}
    events = _stated_events(held)
    feet, every = feet_of_plates(plates, rate, options, warnings, markers, events)
    warnings.append("force plates have no cells: no pressures, areas and regions; the CoP is in the laboratory's axes")
    frames = len(next(iter(feet.values())).force)
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=np.arange(frames) / rate,
        feet=feet,
        metadata={"plates": count, "sees_every_step": every, "axes": _TO_Z_UP[up]},
        warnings=tuple(dict.fromkeys(warnings)),
        kind="plate",
        events=events,
    )


def _stated_events(held: Mapping[str, NDArray[Any]]) -> dict[Side, StatedEvents]:
    found = {side: StatedEvents(held[f"strikes_{side}"], held[f"lifts_{side}"]) for side in SIDES}
    return {side: own for side, own in found.items() if len(own.heel_strikes) or len(own.toe_offs)}


def _cut_short(head: bytes, held: Mapping[str, NDArray[Any]]) -> list[str]:
    first, last = struct.unpack_from("<HH", head, 6)
    (samples,) = struct.unpack_from("<H", head, 18)
    read = int(held["frames"])
    stated = (last - first + 1) * samples
    if last == 65535 or last < first or not read < stated:  # long ones state their frames elsewhere
        return []
    return [f"the file is cut short: {read} of {stated} frames are there"]


def _axes(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Plate axes as columns (3, 3) in the laboratory, from corners +x +y, -x +y, -x -y, +x -y (C3D guide)."""
    x = corners[0] + corners[3] - corners[1] - corners[2]
    y = corners[0] + corners[1] - corners[2] - corners[3]
    z = np.cross(x, y)
    if not np.linalg.norm(z) > 0.0:
        return np.eye(3)
    x = x / np.linalg.norm(x)
    z = z / np.linalg.norm(z)
    return np.column_stack([x, np.cross(z, x), z])


def _vertical_axis(corners: list[NDArray[np.float64]], warnings: list[str]) -> int:
    """Laboratory axis perpendicular to the plates' surfaces; else z."""
    normals = [np.abs(_axes(c)[:, 2]) for c in corners if len(c) == 4 and np.isfinite(c).all() and np.ptp(c) > 0.0]
    if not normals:
        warnings.append(
            "the plates state no corners: z is taken as the vertical axis, and the CoP is in each plate's own axes, "
            "which may be mirrored; left and right may be exchanged (--plates overrides)"
        )
        return 2
    mean = np.mean(normals, axis=0)
    axis = int(np.argmax(mean))
    if mean[axis] < _TILT:
        warnings.append("a force plate is tilted: its vertical force is that along the laboratory's vertical axis")
    if axis != 2:
        warnings.append(f"the plates' corners show that {'xyz'[axis]} is the laboratory's vertical axis")
    return axis


def _plate(
    held: Mapping[str, NDArray[Any]], number: int, up: int, length: float, unit: str | None, warnings: list[str]
) -> Plate:
    kind = int(held[f"type_{number}"])
    channels = held[f"channels_{number}"]
    name = f"plate {number + 1}"
    if not 1 <= kind <= 5:
        raise FormatError(f"{name} is of type {kind}; allowed: types 1 to 5")
    if not len(channels):
        raise FormatError(f"{name} names channels that the file does not hold; allowed: all channels of its type")
    matrix = held[f"matrix_{number}"]
    if kind in (4, 5) and matrix.shape != (6, len(channels)):
        raise FormatError(f"{name} of type {kind} states no calibration matrix of 6 x {len(channels)}")
    units = [plain(str(u)) for u in held[f"units_{number}"]]
    in_volts = [u for u in units if u in ("v", "mv", "uv", "volt", "volts", "d.u.", "counts", "bits")]
    if in_volts and kind < 4 and unit is None:
        raise FormatError(
            f"the channels of {name} are in {in_volts[0]}, and no calibration matrix makes forces of them; allowed: "
            "forces and moments in N and N mm, a plate of type 4 or 5, or --unit N where they are in N all the same"
        )
    if unit is not None:
        units = [plain(unit), *units[1:]] if kind == 3 else [plain(unit)] * 3 + [""] * 3
    values = possible(channels)
    newton, newton_metre = _scales(units, kind, length, name, values, warnings)
    origin = np.array(held[f"origin_{number}"], dtype=float)
    local, moment = _load(
        kind, matrix @ values if kind >= 4 else values, origin, newton, newton_metre, length, warnings
    )
    corners = held[f"corners_{number}"]
    if len(corners) != 4 or not np.isfinite(corners).all():
        corners = np.array([[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]]) * 1e-9
    axes = _axes(corners)
    order = _TO_Z_UP[up]
    known = float(np.ptp(corners)) > 1e-6
    ground = length * corners[:, order][:, :2]
    middle = ground.mean(axis=0)
    cop = None
    free = None
    upward = float(np.sign(axes[order[2], 2]) or 1.0)
    if kind == 1:  # which states the CoP itself, and the free moment about its own z axis
        cop = length * (axes[:, :2] @ values[3:5]).T[:, order][:, :2] + middle
        free = upward * newton_metre * values[5]
    return Plate(
        name,
        (axes @ local).T[:, order],
        None if kind == 1 else (axes @ moment).T[:, order],
        cop,
        free,
        origin=middle,
        corners=ground if known else None,
        placed=known,
        normal=upward * axes[order, 2],
    )


def _scales(
    units: list[str], kind: int, length: float, name: str, values: NDArray[np.float64], warnings: list[str]
) -> tuple[float, float]:
    """N and N m in a unit of a plate's forces and moments; a matrix gives N, and N times the points' length."""
    if kind >= 4:
        return 1.0, length
    force = units[0]
    newton = FORCES.get(force, 1.0)
    if force not in FORCES:
        top = float(np.nanpercentile(np.abs(values[2] if kind < 3 else values[4:].sum(axis=0)), 99.5))
        newton = 1e3 if _KILONEWTONS[0] <= top <= _KILONEWTONS[1] else 1.0
        assumed = "N" if newton == 1.0 else f"kN, since it reaches {top:.2g},"
        warnings.append(f"a unit of force {force!r} of {name} is not known: {assumed} is assumed")
    if kind == 3 or units[5] in MOMENTS:
        return newton, MOMENTS.get(units[5], length)
    # The largest unit with which the CoP stays on a plate; of type 1, with which the moment is that of a foot's turn.
    loaded = np.abs(values[2]) > 0.3 * float(np.nanmax(np.abs(values[2]), initial=0.0))
    moment = np.hypot(*values[3:5, loaded]) if kind == 2 else np.abs(values[5, loaded])
    far = float(np.nanmedian(moment / (newton * np.abs(values[2, loaded])))) if loaded.any() else 0.0
    most = _LONGEST_PLATE if kind == 2 else _LARGEST_TURN
    arm = next((unit for unit in (newton, 1.0, 1e-3) if far * unit < most), length)
    shown = {1e3: "kN m", 1.0: "N m", 1e-3: "N mm"}.get(arm, "N by the points' unit of length")
    warnings.append(f"a unit of moment {units[5]!r} of {name} is not known: {shown} is assumed")
    return newton, arm


def _load(
    kind: int,
    values: NDArray[np.float64],
    origin: NDArray[np.float64],
    newton: float,
    newton_metre: float,
    length: float,
    warnings: list[str],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Force (3, n) in N and moment (3, n) in N m about the surface's middle in plate axes; 0 of type 1."""
    if kind == 1:
        return newton * values[:3], np.zeros((3, values.shape[1]))
    if kind == 3:
        fx12, fx34, fy14, fy23, fz1, fz2, fz3, fz4 = newton * values
        a, b, depth = length * origin
        force = np.array([fx12 + fx34, fy14 + fy23, fz1 + fz2 + fz3 + fz4])
        depth = -abs(depth)  # the surface is above the transducers: the plate's z points down
        moment = np.array(
            [
                b * (fz1 + fz2 - fz3 - fz4) + force[1] * depth,
                a * (-fz1 + fz2 + fz3 - fz4) - force[0] * depth,
                b * (fx34 - fx12) + a * (fy14 - fy23),
            ]
        )
        return force, moment
    force = newton * values[:3]
    moment = newton_metre * values[3:]
    offset = length * origin
    if offset[2] > 0.0:
        warnings.append(
            "a plate's origin lies above its surface: its sign is turned, as its moments are of a point below it"
        )
        offset = -offset
    # The origin is the way from the moments' point to the surface's middle: M' = M - offset x F = M + F x offset.
    return force, moment + np.cross(force.T, offset).T


FORMAT = Format(
    name="c3d", title="force plates in a C3D file", suffixes=(".c3d",), recognises=_recognises, read=_read, order=17
)
