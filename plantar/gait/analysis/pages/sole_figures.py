"""Figures of soles from above: maximum pressure, CoP paths, regions."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.formats.recorded_layouts import subset
from plantar.gait.analysis.masks import Masks
from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.geometry.polygon import convex_hull, signed_margin
from plantar.layouts.layout import SoleLayout
from plantar.plotting import COLOURS, draw_cells, draw_classes, new_figure
from plantar.recordings.pressure_recording import PressureRecording

# CoP paths drawn a foot, thin, next to the mean one; of more steps every n-th: the map below has to be seen.
MOST_PATHS = 12
_FORWARD = "forward (mm)"
_RIGHT = "to the right (mm)"
_STANCE = np.linspace(0.0, 1.0, 51)  # Shares of the stance at which paths are averaged
# Colours of the regions: Tol's bright scheme, which colour-blind readers distinguish.
REGION_COLOURS = (
    *("#4477aa", "#66ccee", "#228833", "#ccbb44", "#ee6677", "#aa3377", "#bbbbbb"),
    *("#332288", "#ddaa33", "#99ddff"),
)


class _Cells(NamedTuple):
    layout: SoleLayout
    chosen: NDArray[np.int64]


def _shown(gait: FootGait, platform: bool) -> _Cells:
    layout = gait.foot.layout
    assert layout is not None
    if not platform or gait.picture is None or not (gait.picture > 0.0).any():
        return _Cells(layout, np.arange(len(layout)))
    chosen, ring = stepped_on(layout, gait.picture > 0.0)
    return _Cells(replace(subset(layout, chosen.tolist()), outline=ring), chosen)


def _panels(shown: Mapping[Side, _Cells], extra: float) -> tuple[Any, Any]:
    extents = [np.ptp(cells.layout.outline, axis=0) for cells in shown.values()]
    slender = max(float(length / width) for length, width in extents)
    size = 2.7 * len(shown) + extra, min(6.4, 1.6 + 2.0 * slender)
    figure, axes = new_figure(*size, columns=len(shown), squeeze=False)
    figure.set_layout_engine("compressed")  # panels of one aspect stand next to each other without a gap
    return figure, axes


def _draw_pictures(
    figure: Any, axes: Any, panels: Sequence[tuple[str, FootGait, _Cells]], what: str, raw: bool
) -> None:
    factor = 1.0 if raw else 1e-3
    pictures = [gait.picture[cells.chosen] * factor for _, gait, cells in panels if gait.picture is not None]
    highest = max(float(values.max()) for values in pictures)
    for panel, (title, _, cells), values in zip(axes[0], panels, pictures, strict=True):
        drawn = draw_cells(panel, cells.layout, np.where(values > 0.0, values, np.nan), highest)
        panel.set(title=title, xlabel=_RIGHT)
    axes[0][0].set_ylabel(_FORWARD)
    figure.colorbar(drawn, ax=list(axes[0]), label=f"{what} ({'counts' if raw else 'kPa'})", shrink=0.8)


def figure_pressure(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Returns figure of maximum pressure and CoP paths of a recording's feet; None without geometry."""
    pictured = {side: gait for side, gait in feet.items() if gait.picture is not None}
    if not pictured:
        return None
    platform = recording.kind == "platform"
    shown = {side: _shown(gait, platform) for side, gait in pictured.items()}
    figure, axes = _panels(shown, 1.6)
    panels = [(f"{s} foot, {_steps_of_picture(gait)}", gait, shown[s]) for s, gait in pictured.items()]
    of_steps = not platform and any(gait.steps for gait in pictured.values())
    what = f"maximum pressure{', mean of the steps' if of_steps else ''}"
    _draw_pictures(figure, axes, panels, what, recording.raw)
    for panel, gait in zip(axes[0], pictured.values(), strict=True):
        _draw_paths(panel, gait)
    _legend(figure, axes[0], "outside lower center", ncols=2, facecolor="#8a8f98", labelcolor="#111111")
    return figure


def _steps_of_picture(gait: FootGait) -> str:
    if not gait.steps:
        return "all frames"
    return f"{len(gait.steps)} step{'' if len(gait.steps) == 1 else 's'}"


def _legend(figure: Any, panels: Iterable[Any], place: str, **look: Any) -> None:
    entries: dict[str, Any] = {}
    for panel in panels:
        handles, names = panel.get_legend_handles_labels()
        entries = dict(zip(names, handles, strict=True)) | entries
    if entries:
        figure.legend(entries.values(), entries.keys(), loc=place, fontsize=9, **look)


def _draw_paths(panel: Any, gait: FootGait) -> None:
    if gait.cop is None or not gait.used:
        return
    paths = [gait.cop[step.contact.begin : step.contact.end] for step in gait.used]
    every = -(-len(paths) // MOST_PATHS)
    for i, path in enumerate(paths[::every]):
        name = None if i else "CoP path of a step"
        panel.plot(-path[:, 1], path[:, 0], color="#ffffff", linewidth=0.7, alpha=0.6, label=name)
    if (mean := _mean_path(paths)) is not None:
        panel.plot(-mean[:, 1], mean[:, 0], color="#ffffff", linewidth=3.4)
        panel.plot(-mean[:, 1], mean[:, 0], color=COLOURS["cop"], linewidth=1.8, label="mean CoP path")


def _mean_path(paths: Sequence[NDArray[np.float64]]) -> NDArray[np.float64] | None:
    known = [part for path in paths if len(part := path[np.isfinite(path[:, 0])]) >= 2]
    if not known:
        return None
    even = [[np.interp(_STANCE, np.linspace(0.0, 1.0, len(path)), column) for column in path.T] for path in known]
    return np.asarray(np.mean(even, axis=0)).T


def figure_pair(recordings: Sequence[tuple[str, PressureRecording, Mapping[Side, FootGait]]]) -> Any | None:
    """Maximum pressure pictures of recordings (name, recording, feet) on one scale; None without geometry."""
    if not all(any(gait.picture is not None for gait in feet.values()) for _, _, feet in recordings):
        return None
    panels = [
        (f"{name}, {side} foot", gait, _shown(gait, recording.kind == "platform"))
        for name, recording, feet in recordings
        for side, gait in feet.items()
        if gait.picture is not None
    ]
    figure, axes = new_figure(2.4 * len(panels) + 1.4, 5.6, columns=len(panels), squeeze=False)
    figure.set_layout_engine("compressed")
    _draw_pictures(figure, axes, panels, "maximum pressure", recordings[0][1].raw)
    return figure


class _Regions(NamedTuple):
    gait: FootGait
    print_: Footprint
    region: NDArray[np.int64]


def figure_regions(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> Any | None:
    """Returns figure of regions, axes and thirds of a recording's feet; of platforms each first print.

    None without regions.
    """
    platform = recording.kind == "platform"
    found = {side: _regions(gait, platform) for side, gait in feet.items()}
    drawn = {side: own for side, own in found.items() if own is not None}
    if not drawn:
        return None
    shown = {side: _shown(own.gait, platform) for side, own in drawn.items()}
    figure, axes = _panels(shown, 1.8)
    for panel, (side, own) in zip(axes[0], drawn.items(), strict=True):
        layout, chosen = shown[side]
        draw_classes(panel, layout, own.region[chosen], _colours(own.gait.masks))
        draw_lines(panel, own.print_, axis=axis_is_inside(own.print_), color="#111111", label="foot axis")
        panel.set(title=f"{side} foot", xlabel=_RIGHT)
    axes[0][0].set_ylabel(_FORWARD)
    masks = next(iter(drawn.values())).gait.masks
    _list_regions(axes[0][-1], masks, {int(i) for own in drawn.values() for i in own.region})
    _legend(figure, axes[0], "outside right center")
    return figure


def _regions(gait: FootGait, platform: bool) -> _Regions | None:
    print_ = gait.footprint
    region = gait.region
    if platform and gait.steps and gait.steps[0].footprint is not None and gait.foot.layout is not None:
        print_ = gait.steps[0].footprint
        region = gait.steps[0].region
    return None if print_ is None or region is None else _Regions(gait, print_, region)


def draw_lines(panel: Any, print_: Footprint, scale: float = 1.0, axis: bool = True, **look: Any) -> None:
    """Draw the thirds of `print_` in a `panel`, and if wanted its `axis` with a `look`, times a `scale`."""
    low = float(print_.rings[:, :, 1].min())
    high = float(print_.rings[:, :, 1].max())
    lines = [((u, low), (u, high)) for u in print_.toeless_length * np.arange(4) / 3.0]
    for ends in (*lines, ((0.0, 0.0), (print_.length, 0.0)))[: 5 if axis else 4]:
        x, y = scale * print_.from_foot(np.array(ends)).T
        thirds = {"color": "#111111", "linewidth": 0.8, "linestyle": ":"}
        panel.plot(-y, x, **(thirds if ends in lines else {"linewidth": 1.4, **look}))


def axis_is_inside(print_: Footprint) -> bool:
    """Whether a print axis' ends and middle are within a twentieth of its width of its hull."""
    hull = convex_hull(print_.rings.reshape(-1, 2))
    places = np.array([0.02, 0.5, 0.98]) * print_.length
    return all(signed_margin(hull, np.array([u, 0.0])) >= -0.05 * print_.width for u in places)


def _colours(masks: Masks) -> list[str]:
    return [REGION_COLOURS[i % len(REGION_COLOURS)] for i in range(len(masks.names))]


def _list_regions(panel: Any, masks: Masks, used: set[int]) -> None:
    for i, (colour, title) in enumerate(zip(_colours(masks), masks.titles.values(), strict=True)):
        if i in used:
            panel.plot([], [], "s", color=colour, label=title)
    panel.plot([], [], ":", color="#111111", label="thirds without toes")


_MARGIN = 0.01  # Width in m of the frame around the cells


def stepped_on(layout: SoleLayout, hit: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Returns indices (m,) of stepped-on cells and neighbours, and corners (4, 2) in m around them.

    `hit`: stepped-on cells (k,); all are returned where none is.
    """
    beside = np.array([any(hit[j] for j in near) for near in layout.neighbours])
    chosen = np.flatnonzero(hit | beside) if hit.any() else np.arange(len(layout))
    points = np.vstack([layout.cell_polygon(int(c)) for c in chosen])
    x0, y0 = points.min(axis=0) - _MARGIN
    x1, y1 = points.max(axis=0) + _MARGIN
    return chosen, np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
