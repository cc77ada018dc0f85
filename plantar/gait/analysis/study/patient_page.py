"""Sheet of one person against a group: in words first, then in numbers."""

import html
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from plantar.common.pages.page import Section, embedded, number, page, probability, row, table, titled, warning_list
from plantar.gait.analysis.measures import full_title, unit_of
from plantar.gait.analysis.pages.force_figures import STANCE
from plantar.gait.analysis.study.one_against_group import ENOUGH_IN_GROUP, OneAgainstGroup, Standing
from plantar.gait.analysis.study.statistics import student_quantile
from plantar.plotting import COLOURS, drawn_name, new_figure

_NAMED = 8  # Measures that the words name; the tables have all
_FOUND = "#f2c14e"


def patient_page(one: OneAgainstGroup, figures: Sequence[tuple[Path, str]], version: str) -> str:
    """Returns HTML of a person's sheet; figures are PNG files with captions."""
    sections = [Section("summary", "In words", _words(one))]
    if figures:
        sections.append(Section("figures", "Force and pressure", embedded(figures)))
    for side, rows in one.measures.items():
        if rows:
            sections.append(Section(f"measures-{side}", f"{side.capitalize()} foot", _table(one, side)))
    sections.append(Section("how", "How to read this", _how(one)))
    about = (
        f'<p class="about">Compared with {one.n} people of {html.escape(one.group)}. Plantar {html.escape(version)}. '
        "A measurement, not a diagnosis.</p>"
    )
    return page(f"{one.participant} beside {one.group}", about, sections)


def differing(one: OneAgainstGroup) -> list[tuple[str, str, Standing]]:
    """Side, key and standing of the measures in which the person differs, all allowed for; largest |t| first."""
    found = [(s, k, v) for s, rows in one.measures.items() for k, v in rows.items() if v.p_all <= 0.05]
    return sorted(found, key=lambda item: -abs(item[2].t))


def _words(one: OneAgainstGroup) -> str:
    who = html.escape(one.participant)
    count = sum(map(len, one.measures.values()))
    found = differing(one)
    parts = []
    if found:
        feet = "both feet" if len(one.measures) > 1 else f"the {next(iter(one.measures))} foot"
        verb = "is" if len(found) == 1 else "are"
        parts.append(f"<p>Of {count} measures of {feet}, {len(found)} {verb} unlike those of the group:</p>")
        parts.append("<ul>" + "".join(f"<li>{_sentence(*item)}</li>" for item in found[:_NAMED]) + "</ul>")
        if len(found) > _NAMED:
            parts.append(f"<p>{len(found) - _NAMED} more are marked in the tables.</p>")
    elif one.n >= ENOUGH_IN_GROUP:
        parts.append(f"<p>No measure of {who} is unlike those of the group when all {count} are allowed for.</p>")
    else:
        alone = [(s, k, v) for s, rows in one.measures.items() for k, v in rows.items() if v.p <= 0.05]
        by_chance = 0.05 * count
        parts.append(
            f"<p>{len(alone)} of {count} measures lie outside the range of 95 % of people like the group; about "
            f"{by_chance:.0f} would by chance.</p>"
        )
        alone.sort(key=lambda item: -abs(item[2].t))
        parts.append("<ul>" + "".join(f"<li>{_sentence(*item)}</li>" for item in alone[:_NAMED]) + "</ul>")
    for side, curve in one.curves.items():
        at = np.flatnonzero(curve.differs)
        if len(at):
            high = "above" if float(np.mean(curve.t[at])) > 0.0 else "below"
            parts.append(
                f"<p>The force of the {side} foot is {high} the group's for {len(at)} of 101 instants of the stance, "
                f"between {at[0]} and {at[-1]} %.</p>"
            )
    for side, map_ in one.maps.items():
        places = int(map_.differs.sum())
        if places:
            share = 100.0 * places / len(map_.t)
            parts.append(f"<p>The pressure map of the {side} foot differs on {share:.0f} % of the sole.</p>")
    parts += [warning_list(one.notes)] if one.notes else []
    return "".join(parts)


def _sentence(side: str, key: str, found: Standing) -> str:
    unit, factor = unit_of(key)
    value, low, high = (number(v * factor) for v in (found.value, found.low, found.high))
    way = "higher" if found.value > found.mean else "lower"
    share = found.below_percent if way == "higher" else 100.0 - found.below_percent
    title = html.escape(full_title(key))
    return (
        f"{title}, {side} foot: <strong>{value} {unit}</strong>. 95 of 100 people like the group have {low} to {high} "
        f"{unit}; it is {way} than in about {_percent(share)} of them."
    )


def _percent(share: float) -> str:
    return f"{share:.0f} %" if share < 99.0 else f"{min(share, 99.9):.1f} %"


def _table(one: OneAgainstGroup, side: Any) -> str:
    rows = []
    for key, found in one.measures[side].items():
        unit, factor = unit_of(key)
        low, high = (number(v * factor) for v in (found.low, found.high))
        cells = [number(found.value * factor), number(found.mean * factor), f"{low}\u00a0to\u00a0{high}"]
        if math.isfinite(found.t):
            ends = f"[{found.below_low:.1f},\u00a0{found.below_high:.1f}]"
            cells += [f"{found.below_percent:.1f} {ends}", number(found.t, 2), probability(found.p)]
        else:
            cells += ["–"] * 3
        all_ = probability(found.p_all)
        cells.append(f"<strong>{all_}</strong>" if found.p_all <= 0.05 else all_)
        rows.append(row(html.escape(titled(full_title(key), unit)), cells))
    head = (
        "Measure",
        html.escape(one.participant),
        "Group, mean",
        "95 % of people",
        "Share below (%) [95 % CI]",
        "t",
        "p",
        "p (all)",
    )
    caption = f"Means over steps and recordings; {one.n} people. p (all) allows for all measures of all feet."
    return table(f"{side} foot", caption, head, rows)


def _how(one: OneAgainstGroup) -> str:
    return (
        "<p>Each measure of the person is compared with the same side of the group's people. <b>95 % of people</b>: "
        "where 95 of 100 people like the group are expected, from its mean, spread and size. <b>Share below</b>: the "
        "estimated share of such people with a smaller value. <b>p</b>: how often a person like the group is that far "
        "away, in this measure alone (Crawford &amp; Howell 1998). <b>p (all)</b>: how often anyone of the group, put "
        "in the person's place, is that far away in any measure: up to 0.05 is called unlike the group, and of people "
        f"who are like the group 5 in 100 are called so. It takes a group of {ENOUGH_IN_GROUP} or more. A value "
        "outside the range is neither good nor bad by itself: speed, footwear and mass change most of them.</p>"
    )


def patient_figures(one: OneAgainstGroup) -> list[tuple[str, Any, str]]:
    """Name, figure (None if empty) and caption of the person's curves and maps beside the group's."""
    curves = f"Vertical force of {one.participant} (line) and 95 % of people like the group (band)"
    maps = f"Maximum pressure of {one.participant}, and mean of the group"
    if one.n >= ENOUGH_IN_GROUP:
        curves += "; shaded where it differs, all instants allowed for"
        maps += "; outlined where they differ, all places allowed for"
    return [("patient_curves", _draw_curves(one), curves), ("patient_maps", _draw_maps(one), maps)]


def _draw_curves(one: OneAgainstGroup) -> Any | None:
    if not one.curves:
        return None
    figure, axes = new_figure(
        4.6 * len(one.curves), 3.4, columns=len(one.curves), grid=True, sharey=True, squeeze=False
    )
    for panel, (side, curve) in zip(axes[0], one.curves.items(), strict=True):
        n = one.n
        reach = student_quantile(0.975, n - 1) * curve.sd * math.sqrt((n + 1.0) / n)
        grey = COLOURS["reference"]
        panel.fill_between(STANCE, curve.mean - reach, curve.mean + reach, color=grey, alpha=0.25, linewidth=0)
        panel.plot(STANCE, curve.mean, color=grey, linewidth=1.2, label="group")
        panel.plot(STANCE, curve.value, color=COLOURS[side], linewidth=1.8, label=drawn_name(one.participant))
        if curve.differs.any():
            low, high = panel.get_ylim()
            panel.fill_between(STANCE, low, high, where=curve.differs, color=_FOUND, alpha=0.35, zorder=0, linewidth=0)
            panel.set_ylim(low, high)
        panel.set(title=f"{side} foot", xlabel="stance (%)")
        panel.margins(x=0.0)
        panel.legend(fontsize=8, loc="lower center")
    axes[0][0].set_ylabel(f"vertical force ({one.curve_unit})")
    return figure


def _draw_maps(one: OneAgainstGroup) -> Any | None:
    if not one.maps:
        return None
    figure, axes = new_figure(2.2 * 2 * len(one.maps), 4.2, columns=2 * len(one.maps), squeeze=False)
    factor, unit = (1.0, "counts") if one.curve_unit == "counts" else (1e-3, "kPa")
    highest = factor * max(float(max(m.value.max(), m.mean.max())) for m in one.maps.values()) or 1.0
    drawn = None
    for i, (side, map_) in enumerate(one.maps.items()):
        places = one.places[side]
        for panel, name, values in ((axes[0][2 * i], "person", map_.value), (axes[0][2 * i + 1], "group", map_.mean)):
            grid = np.full(places.shape, np.nan)
            grid[places] = values
            turned = grid if side == "left" else grid[:, ::-1]  # columns from lateral to medial; toes up
            frame: dict[str, Any] = {"origin": "lower", "extent": (0.0, 1.0, 0.0, 1.0), "aspect": 2.6}
            drawn = panel.imshow(factor * turned, vmin=0.0, vmax=highest, cmap="viridis", **frame)
            across = "lateral to medial" if side == "left" else "medial to lateral"
            panel.set(title=f"{side}, {name}", xlabel=across, xticks=[], yticks=[])
        differs = np.zeros(places.shape)
        differs[places] = map_.differs
        if differs.any():
            high, wide = places.shape
            shown = differs if side == "left" else differs[:, ::-1]
            rows = (np.arange(high) + 0.5) / high
            columns = (np.arange(wide) + 0.5) / wide
            axes[0][2 * i].contour(columns, rows, shown, levels=[0.5], colors="#ffffff", linewidths=1.4)
    axes[0][0].set_ylabel("length of the sole, toes up")
    if drawn is not None:
        figure.colorbar(drawn, ax=list(axes[0]), label=f"maximum pressure ({unit})", shrink=0.8)
    return figure
