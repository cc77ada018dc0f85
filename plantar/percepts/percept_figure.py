"""A percept as a figure, as JSON and as a line of text.

`Percept` shows itself by these, so it is not imported here: `percept` is one in every signature.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.plotting import COLOURS, draw_cells, drawn_name, html_of, new_figure, ticks_in_mm

_FULL = 10.0  # thresholds, the least end of the colours: the noise of a foot in the air does not look like a load
_CONTOURS = ("#ffffff", "#ffd166", "#f4a259", "#e4572e", "#d81b60")


def percept_text(percept: Any) -> str:
    """A percept in a line: taxels, load and center of pressure."""
    active = int(np.count_nonzero(percept.active))
    cop = percept.position_cop_in_sole
    place = "no contact" if cop is None else f"CoP {1e3 * cop[0]:.1f}, {1e3 * cop[1]:.1f} mm"
    load = f"{percept.vertical_force:.1f} N"
    return f"'{percept.layout.name}', {active} of {len(percept.layout)} taxels active, {load}, {place}"


def percept_dict(percept: Any) -> dict[str, Any]:
    """What a sole perceives, for JSON: SI units, sole frame; None for an absent modality, [] for an empty shape."""
    circle = percept.inscribed_circle_in_sole
    contours = percept.height_contours_in_sole
    plane = percept.ground_plane_in_sole
    return {
        "time_s": percept.reading.time,
        "layout": percept.layout.name,
        "taxels": len(percept.layout),
        "active": np.flatnonzero(percept.active).tolist(),
        "faulty": np.flatnonzero(percept.health.faulty).tolist(),
        "force_N": _numbers(percept.reading.force),
        "force_threshold_N": percept.force_threshold,
        "vertical_force_N": percept.vertical_force,
        "contact_area_m2": percept.contact_area,
        "cop_m": _numbers(percept.position_cop_in_sole),
        "wrench": _numbers(percept.wrench_in_sole),
        "convex_polygon_m": _numbers(percept.support_polygon_in_sole),
        "concave_polygon_m": [_numbers(ring) for ring in rings_of(percept)],
        "inscribed_rectangle_m": _numbers(percept.inscribed_rectangle_in_sole),
        "contact_rectangle_m": _numbers(percept.outline_rectangle_in_sole),
        "inscribed_circle": None
        if circle is None
        else {"center_m": _numbers(circle.center), "radius_m": circle.radius},
        "proximity_m": _numbers(percept.reading.proximity),
        "preemptive_polygon_m": _numbers(percept.preemptive_polygon_in_sole),
        "height_contours": None
        if contours is None
        else [{"height_m": c.height, "polygon_m": _numbers(c.polygon_in_sole)} for c in contours],
        "virtual_wrench": _numbers(percept.virtual_wrench_in_sole),
        "ground_plane": None if plane is None else {"height_m": plane.height, "slope": _numbers(plane.slope)},
    }


def rings_of(percept: Any) -> list[NDArray[np.float64]]:
    """Rings (k, 2) of a percept's concave outline in sole frame in m: islands, and holes in them."""
    outline = percept.concave_outline_in_sole
    return [outline.points[a:b] for a, b in zip(outline.starts[:-1], outline.starts[1:], strict=True)]


def percept_figure(percept: Any, title: str = "") -> Any:
    """Figure of a percept, toes up: forces and shapes of the contact, and what is near where that is sensed."""
    near = percept.reading.proximity is not None
    figure, panels = new_figure(9.0 if near else 5.6, 6.2, columns=1 + near, squeeze=False)
    _draw_contact(figure, panels[0, 0], percept)
    if near:
        _draw_proximity(figure, panels[0, 1], percept)
    figure.suptitle(title or f"{drawn_name(percept.layout.name)}, {percept.reading.time:.3f} s")
    return figure


def percept_html(percept: Any) -> str:
    """A percept's line and figure, for notebooks."""
    return html_of(percept_figure(percept), f"Percept({percept_text(percept)})")


def _draw_contact(figure: Any, axes: Any, percept: Any) -> None:
    force = np.where(percept.health.faulty, np.nan, percept.reading.force)
    known = force[np.isfinite(force)]
    highest = max(float(known.max(initial=0.0)), _FULL * percept.force_threshold)
    cells = draw_cells(axes, percept.layout, force, highest)
    figure.colorbar(cells, ax=axes, label="force on a taxel in N", shrink=0.7)
    for index, ring in enumerate(rings_of(percept)):
        _ring(axes, ring, "concave polygon" if index == 0 else None, color=COLOURS["cop"], linewidth=2.2)
    _ring(axes, percept.support_polygon_in_sole, "convex polygon", color="#4dd0e1", linewidth=2.0)
    rectangle = percept.inscribed_rectangle_in_sole
    _ring(axes, rectangle, "largest rectangle inside", color=COLOURS["active"], linestyle="--", linewidth=1.6)
    if (circle := percept.inscribed_circle_in_sole) is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, 90)
        around = circle.center + circle.radius * np.column_stack([np.cos(turn), np.sin(turn)])
        _ring(axes, around, "largest circle inside", color="#b39ddb", linestyle=":", linewidth=1.8)
    if (cop := percept.position_cop_in_sole) is not None:
        axes.plot(-cop[1], cop[0], "o", markersize=10, color="#ffffff", markeredgecolor="#111111", label="CoP")
    wrench = percept.wrench_in_sole
    axes.set_title(
        f"{percept.vertical_force:.0f} N on {1e4 * percept.contact_area:.0f} cm²\n"
        f"wrench {_text(wrench[:3], '.0f')} N, {_text(wrench[3:], '.1f')} N m",
        fontsize=9,
    )
    _finish(axes)


def _draw_proximity(figure: Any, axes: Any, percept: Any) -> None:
    distance = np.asarray(percept.reading.proximity, dtype=float)
    shown = np.where(np.isfinite(distance), 1e3 * distance, np.nan)
    known = shown[np.isfinite(shown)]
    cells = draw_cells(axes, percept.layout, shown, float(known.max(initial=0.0)))
    figure.colorbar(cells, ax=axes, label="distance of the ground in mm", shrink=0.7)
    contours = percept.height_contours_in_sole or ()
    for index in reversed(range(len(contours))):  # the highest first and widest: equal ones stay visible
        contour = contours[index]
        label = f"nearer than {1e3 * contour.height:.0f} mm: {int(contour.taxels.sum())}"
        color = _CONTOURS[index % len(_CONTOURS)]
        _ring(axes, contour.polygon_in_sole, label, color=color, linewidth=1.8 + 1.2 * index)
    near = percept.preemptive_polygon_in_sole
    _ring(axes, near, "preemptive polygon", color="#4dd0e1", linestyle="--", linewidth=1.4)
    wrench = percept.virtual_wrench_in_sole
    if wrench is not None:
        axes.set_title(f"virtual wrench\n{_text(wrench[:3], '.1f')} N, {_text(wrench[3:], '.2f')} N m", fontsize=9)
    _finish(axes)


def _ring(axes: Any, points: NDArray[np.float64] | None, label: str | None, **style: Any) -> None:
    if points is None or not len(points):
        return
    closed = np.vstack([points, points[:1]])
    axes.plot(-closed[:, 1], closed[:, 0], label=label, **style)


def _finish(axes: Any) -> None:
    axes.set_xlabel("to the right in mm")
    axes.set_ylabel("forward in mm")
    ticks_in_mm(axes)
    handles, labels = axes.get_legend_handles_labels()
    if handles:
        below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.11), "ncols": 2}
        axes.legend(handles, labels, fontsize=8, facecolor="#343a40", labelcolor="#ffffff", **below)


def _text(values: NDArray[np.float64], form: str) -> str:
    return ", ".join(f"{value + 0.0:{form}}" for value in values)


def _numbers(values: Any) -> Any:
    """Nested lists, None in place of what is not finite; None for None."""
    if values is None:
        return None
    numbers = np.asarray(values, dtype=float)
    listed = numbers.astype(object)
    listed[~np.isfinite(numbers)] = None
    return listed.tolist()
