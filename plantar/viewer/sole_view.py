"""What a sole perceives at an instant of a recording: `plantar.sole` and `plantar sole`."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import number
from plantar.common.atomic import output_folder
from plantar.errors import InputError
from plantar.formats import ReadOptions, read_recording
from plantar.layouts.layout import Side, SoleLayout
from plantar.layouts.layout_file import read_layout
from plantar.percepts.percept import Percept
from plantar.percepts.percept_figure import percept_dict, percept_figure, percept_text
from plantar.plotting import drawn_name, html_of, save_figure
from plantar.recordings.pressure_recording import FootRecording, PressureRecording
from plantar.recordings.recording import Recording, read_mcap
from plantar.sensing.reading import Reading

_HELD = 0.1  # s for which the last sample of proximity counts


@dataclass(frozen=True, eq=False, repr=False)
class SoleView:
    """A sole's percept at an instant of a recording.

    `percept`: all members, at first use; `side`: left or right; `time`: of the frame in s; `source`: name of the file.
    """

    percept: Percept
    side: Side
    time: float
    source: str

    def __repr__(self) -> str:
        return f"SoleView({self.source} at {self.time:.3f} s, {self.side}: {percept_text(self.percept)})"

    def as_dict(self) -> dict[str, Any]:
        """What the sole perceives, for JSON; SI units, sole frame."""
        return {"recording": self.source, "side": self.side, **percept_dict(self.percept), "time_s": self.time}

    def lines(self) -> list[str]:
        """What the sole perceives, in a few lines."""
        percept = self.percept
        cop = percept.position_cop_in_sole
        circle = percept.inscribed_circle_in_sole
        contours = percept.height_contours_in_sole
        virtual = percept.virtual_wrench_in_sole
        force = ", ".join(f"{value + 0.0:.1f}" for value in percept.wrench_in_sole)
        active = int(percept.active.sum())
        lines = [
            f"{active} of {len(percept.layout)} taxels are loaded, {1e4 * percept.contact_area:.1f} cm2",
            "no center of pressure: no load" if cop is None else f"CoP {1e3 * cop[0]:.1f}, {1e3 * cop[1]:.1f} mm",
            f"wrench {force} (N, N m)",
            f"convex polygon {1e4 * percept.support_area:.1f} cm2, "
            f"concave polygon {1e4 * percept.concave_outline_in_sole.area:.1f} cm2",
            f"inscribed rectangle {_sides_in_mm(percept.inscribed_rectangle_in_sole)}, "
            f"circle {0.0 if circle is None else 2e3 * circle.radius:.0f} mm across",
        ]
        if contours is None or virtual is None:
            return [*lines, "no proximity recorded then"]
        near = ", ".join(f"{int(c.taxels.sum())} nearer than {1e3 * c.height:.0f} mm" for c in contours)
        return [*lines, f"contours: {near}", f"virtual wrench: {virtual[2]:.1f} N upwards"]

    def figure(self) -> Any:
        """Matplotlib figure: forces and shapes of the contact, and beside them what is near where that is recorded."""
        return percept_figure(self.percept, f"{drawn_name(self.source)}, {self.side} sole at {self.time:.3f} s")

    def save(self, folder: str | os.PathLike[str]) -> list[Path]:
        """Write `sole_<side>.png` and `sole_<side>.json` into a folder; returns their paths."""
        names = [f"sole_{self.side}.png", f"sole_{self.side}.json"]
        with output_folder(folder, [self.source]) as out:
            save_figure(self.figure(), out / names[0])
            (out / names[1]).write_text(json.dumps(self.as_dict(), indent=1, allow_nan=False) + "\n", encoding="utf-8")
        return [Path(folder) / name for name in names]

    def _repr_html_(self) -> str:
        return html_of(self.figure(), repr(self))


def sole(
    recording: str | os.PathLike[str] | PressureRecording,
    at: float | None = None,
    foot: str | None = None,
    *,
    layout: SoleLayout | str | os.PathLike[str] | None = None,
    options: ReadOptions | None = None,
) -> SoleView:
    """What a sole perceives at an instant: taxels, CoP, wrench, polygons, inscribed shapes, contours, virtual wrench.

    Args:
        recording: File of any known format, or what `plantar.read` returned.
        at: Time in s; the nearest frame is taken. None: the instant of the greatest load.
        foot: "left" or "right"; None: the one with the greater load then.
        layout: Layout or its file, where the recording has none; mirrored for the other foot.
        options: What else is known of the file.

    Returns:
        View: `.percept`, `.as_dict()`, `.figure()`, `.save(folder)`; a notebook shows the figure.

    Raises:
        InputError: If time or foot are not in the recording, or it has no layout or no forces in N.
        FormatError: If unreadable.

    Example:
        >>> view = sole("run.mcap", at=3.2, foot="left")  # doctest: +SKIP
        >>> view.percept.position_cop_in_sole, view.save("out/sole")  # doctest: +SKIP
    """
    given = read_layout(layout) if isinstance(layout, str | os.PathLike) else layout
    read = (
        recording
        if isinstance(recording, PressureRecording)
        else read_recording(recording, None, given, options=options)
    )
    feet = _usable(read)
    considered = feet if foot is None else {_side_of(foot, feet): feet[_side_of(foot, feet)]}
    frame = _frame_of(read, considered, at)
    side = max(considered, key=lambda s: float(np.nan_to_num(considered[s].vertical_force[frame])))
    time = float(read.time[frame])
    force = np.array(feet[side].force[frame], dtype=np.float64)
    reading = Reading(time, force, proximity=_proximity(read, side, time, len(force)))
    cells = cast(SoleLayout, feet[side].layout)  # `_usable` left out feet without one
    return SoleView(Percept(cells, reading), side, time, read.path.name)


def _sides_in_mm(rectangle: NDArray[np.float64]) -> str:
    length, width = np.ptp(rectangle, axis=0) if len(rectangle) else (0.0, 0.0)
    return f"{1e3 * length:.0f} x {1e3 * width:.0f} mm"


def _usable(read: PressureRecording) -> Mapping[Side, FootRecording]:
    if read.raw:
        raise InputError(f"{read.path.name} holds counts without calibration; allowed: forces, see plantar calibrate")
    feet = {side: foot for side, foot in read.feet.items() if foot.layout is not None and len(foot.force)}
    if not feet:
        raise InputError(f"{read.path.name} has no layout of its cells; give one with --layout, or layout=")
    return feet


def _side_of(foot: str, feet: Mapping[Side, FootRecording]) -> Side:
    for side in feet:
        if side == foot:
            return side
    raise InputError(f"foot is {foot!r}; allowed in this recording: {', '.join(feet)}")


def _frame_of(read: PressureRecording, feet: Mapping[Side, FootRecording], at: float | None) -> int:
    if at is None:
        return int(np.argmax(np.max([np.nan_to_num(foot.vertical_force) for foot in feet.values()], axis=0)))
    time = number(at, "time", finite=True)
    first = float(read.time[0])
    last = float(read.time[-1])
    if not first - 0.5 / read.rate_hz <= time <= last + 0.5 / read.rate_hz:
        raise InputError(f"time is {time:g} s; allowed in {read.path.name}: {first:.3f} to {last:.3f} s")
    return int(np.argmin(np.abs(read.time - time)))


def _proximity(read: PressureRecording, side: Side, time: float, count: int) -> NDArray[np.float64] | None:
    """Last distances (n,) in m of the topic "/proximity/<side>" of an MCAP file; None where none are recorded then."""
    if read.format != "mcap" or not read.path.is_file():
        return None
    recording: Recording = read_mcap(read.path)
    table = recording.topics.get(f"/proximity/{side}")
    if table is None or not len(table) or "distance" not in table.fields:
        return None
    last = int(np.searchsorted(table.time, time + 1e-6, side="right")) - 1
    distance = table.fields["distance"]
    if last < 0 or time - table.time[last] > _HELD or distance.shape[1] != count:
        return None
    return np.asarray(distance[last], dtype=float)
