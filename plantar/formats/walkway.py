"""Pressure walkways of 5 mm cells (StepScan), and stacks of their footsteps, as StepUP-P150 publishes both.

A walkway is an array (frames, rows, columns) of rows along it and columns across, left of who walks to higher rows. A
stack is an array (footsteps, times, rows, columns), toes at row 0. Both are in kPa at 100 Hz unless stated. They are
larger than memory, so that they are read as a stream: see `plantar.gait.analysis.walkway`.
"""

import math
from dataclasses import dataclass
from pathlib import Path

from plantar.common.files.input_file import open_input
from plantar.errors import FormatError
from plantar.formats.format import Format, ReadOptions
from plantar.formats.grid_file import ArrayHead, head_of_array
from plantar.formats.step_table import NAME, PEOPLE
from plantar.formats.units import find_unit
from plantar.recordings.pressure_recording import PressureRecording

PITCH = 0.005
"""Distance of cells in m: StepScan's 4 sensors/cm2, as StepUP-P150 states."""

RATE = 100.0
"""Frames a second, likewise."""

THRESHOLD = 10e3
"""Pressure in Pa from which a cell counts as loaded: that by which StepUP-P150's own code crops footsteps."""

_TILE = 120  # Cells along each edge of a StepScan tile of 0.6 m
_STACK = (40, 20, 10)  # Least times, rows and columns of a stack's footsteps
_FOOT = 0.6  # Largest length in m of a stack's grid: a footstep, no walkway
_HEAD = 1 << 16
_STACK_NAME = "pipeline_1.npz"  # of StepUP-P150, beside other forms of the same walk
_ASIDE = ("trial.npz", "preprocessed.npz", "pipeline_2.npz")


@dataclass(frozen=True)
class WalkwayFile:
    """What a file holds: `stack`, footsteps or frames of a walkway; `rate_hz`; `factor`, Pa of a value; `notes`."""

    path: Path
    stack: bool
    rate_hz: float
    factor: float
    notes: tuple[str, ...]


def is_walkway(path: Path) -> bool:
    """Whether a file is a walkway or a stack of footsteps by its first bytes; False if unreadable."""
    try:
        with open_input(path, FormatError) as stream:
            return _recognises(stream.read(_HEAD))
    except FormatError:
        return False


def walkway_file(path: Path, options: ReadOptions) -> WalkwayFile:
    """Returns what the walkway or stack at a path holds, with what had to be assumed; FormatError if it is neither."""
    with open_input(path, FormatError) as stream:
        head = head_of_array(stream.read(_HEAD))
    if head is None or not (_is_stack(head) or _is_walkway(head)):
        raise FormatError(f"{path}: neither a walkway nor a stack of footsteps")
    unit = find_unit(options.unit) if options.unit else find_unit("kPa")
    if unit is None or unit.kind != "pressure":
        raise FormatError(f"{path}: a walkway in {options.unit!r}; allowed: kPa, N/cm2, mmHg, psi and their like")
    notes = []
    if options.unit is None:
        notes.append("the file states no unit: kPa is assumed, as StepUP-P150's (--unit overrides)")
    if options.rate_hz is None:
        notes.append(f"the file states no rate: {RATE:g} Hz is assumed, as StepUP-P150's (--rate overrides)")
    notes.append(
        f"cells of {1e3 * PITCH:g} mm count as loaded from {1e-3 * THRESHOLD:g} kPa; a contact lasts from the first to "
        "the last loaded frame"
    )
    return WalkwayFile(path, _is_stack(head), options.rate_hz or RATE, unit.factor, tuple(notes))


def one_of_each_walk(paths: list[Path]) -> list[Path]:
    """Paths without StepUP-P150's tables, and what it holds of a walk beside pipeline_1.npz: the walkway, other forms.

    Example:
        >>> [p.name for p in one_of_each_walk([Path("W1/trial.npz"), Path("W1/pipeline_1.npz"), Path("S1/trial.npz")])]
        ['pipeline_1.npz', 'trial.npz']
    """
    stacks = {path.parent for path in paths if path.name == _STACK_NAME}
    arrays = {path.parent for path in paths if path.suffix in FORMAT.suffixes}
    kept = [path for path in paths if path.parent not in stacks or path.name not in _ASIDE]
    return [p for p in kept if p.name != PEOPLE and not (p.name == NAME and p.parent in arrays)]


def _is_stack(head: ArrayHead) -> bool:
    if len(head.shape) != 4:
        return False
    _, *sizes = head.shape
    small = max(sizes[1:]) * PITCH <= _FOOT
    return small and all(size >= least for size, least in zip(sizes, _STACK, strict=True))


def _is_walkway(head: ArrayHead) -> bool:
    if len(head.shape) != 3:
        return False
    _, rows, columns = head.shape
    return rows >= _TILE and columns >= _TILE and rows % _TILE == 0 and columns % _TILE == 0


def _recognises(data: bytes) -> bool:
    head = head_of_array(data)
    return head is not None and (_is_stack(head) or _is_walkway(head))


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    with open_input(path, FormatError) as stream:
        head = head_of_array(stream.read(_HEAD))
    shape = () if head is None else head.shape
    raise FormatError(
        f"a walkway or footsteps of shape {shape}, {math.prod(shape) * 8 / 1e9:.2g} GB as one recording; allowed: "
        "plantar analyze, which measures its footsteps one by one"
    )


FORMAT = Format(
    name="walkway",
    title="StepScan walkways and StepUP-P150 footsteps",
    suffixes=(".npz", ".npy"),
    recognises=_recognises,
    read=_read,
    order=55,
)
