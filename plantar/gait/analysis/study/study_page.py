"""Page of a study and its figures."""

import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from plantar.common.pages.page import (
    Section,
    figures_of,
    group_row,
    number,
    page,
    probability,
    row,
    scaled,
    table,
    titled,
    warning_list,
)
from plantar.gait.analysis.measures import full_title, unit_of
from plantar.gait.analysis.pages.force_figures import STANCE
from plantar.gait.analysis.steps.steady import FEWEST_STEPS
from plantar.gait.analysis.study.compare_conditions import Comparison
from plantar.gait.analysis.study.mixed_models import MixedEffect
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.reliability import Agreement, Reliability
from plantar.gait.analysis.study.statistics import Effect, student_quantile
from plantar.plotting import COLOURS, drawn_name, new_figure

_MOST = 200  # Rows of a table that the page shows; the CSV tables hold all


@dataclass(frozen=True)
class StudyParts:
    """What a study's page has beside comparisons: changes between factors, reliability, agreement, mixed models."""

    changes: Sequence[Comparison] = ()
    reliability: Mapping[str, Mapping[str, Reliability]] = field(default_factory=dict)
    agreement: tuple[tuple[str, str], Mapping[str, Agreement]] = (("", ""), {})
    mixed: Sequence[MixedEffect] = ()


def study_page(
    summary: Mapping[str, Any],
    results: Sequence[RecordingResult],
    comparisons: Sequence[Comparison],
    figures: Sequence[tuple[Path, str]],
    name: str,
    parts: StudyParts | None = None,
) -> str:
    """Returns HTML of a study by name: `Study.summary`, recordings' results, comparisons of every two conditions.

    Embedded figures are PNG files, with captions.
    """
    sections = [Section("summary", "Summary", _summary(summary, comparisons))]
    for i, one in enumerate(comparisons, 1):
        sections.append(Section(f"comparison-{i}", f"{html.escape(one.a)} and {html.escape(one.b)}", _comparison(one)))
    more = parts or StudyParts()
    for i, one in enumerate(more.changes, 1):
        title = f"{html.escape(one.factor)}: {html.escape(one.a)} and {html.escape(one.b)}"
        sections.append(Section(f"change-{i}", title, _comparison(one)))
    if figures:
        sections.append(figures_of(figures))
    if more.reliability:
        sections.append(Section("reliability", "Reliability", _reliability(more.reliability)))
    if more.agreement[1]:
        sections.append(Section("agreement", "Agreement of devices", _agreement(*more.agreement)))
    if more.mixed:
        sections.append(Section("mixed", "Mixed models", _mixed(more.mixed)))
    recordings = Section("recordings", "Recordings", _recordings(results))
    sections += [Section("look", "To look at", _look(summary)), recordings]
    about = (
        f'<p class="about">{summary["measured"]} of {summary["recordings"]} recordings of {summary["participants"]} '
        f"participants were measured: {summary['steps']} steps. Plantar {html.escape(str(summary['version']))}.</p>"
    )
    return page(f"Study: {name}", about, sections)


def _summary(summary: Mapping[str, Any], comparisons: Sequence[Comparison]) -> str:
    tiles = (
        ("Recordings measured", f"{summary['measured']} of {summary['recordings']}"),
        ("Participants", str(summary["participants"])),
        ("Conditions", str(len(summary["conditions"]))),
        ("Steps", str(summary["steps"])),
    )
    parts = ['<dl class="tiles">' + "".join(f"<div><dt>{n}</dt><dd>{v}</dd></div>" for n, v in tiles) + "</dl>"]
    parts += [f"<p>{html.escape(_sentence(one))}</p>" for one in comparisons]
    if not comparisons:
        parts.append(
            "<p>A table of participants (--participants) with two conditions or more lets them be compared.</p>"
        )
    return "".join(parts)


def _sentence(one: Comparison) -> str:
    if one.note:
        return f"{one.a} and {one.b} are not compared: {one.note}."
    sizes = {key: e.effect_size if math.isfinite(e.effect_size) else None for key, e in one.effects.items()}
    found = [(key, e) for key, e in one.effects.items() if e.p_all < 0.05]
    found.sort(key=lambda pair: -abs(sizes[pair[0]] or 0.0))
    how = "the same participants in both" if one.paired else "different participants"
    pairs = len(one.levels) * (len(one.levels) - 1) // 2
    family = f"{len(one.effects)} measures" + (f" and {pairs} pairs" if pairs > 1 else "")
    if not found:
        return f"{one.a} and {one.b} ({how}): no measure differs when all {family} are allowed for."
    named = [f"{_title(key)[0]} ({'+' if e.difference > 0 else '−'}, g = {number(sizes[key], 2)})" for key, e in found]
    more = "" if len(named) <= 4 else f" and {len(named) - 4} more"
    doubts = "".join(f" {doubt}." for doubt in one.doubts)
    return f"In {one.b} against {one.a} ({how}) these differ: {', '.join(named[:4])}{more}.{doubts}"


def _title(key: str) -> tuple[str, str, float]:
    return full_title(key), *unit_of(key)


def _comparison(one: Comparison) -> str:
    if one.note:
        return f"<p>{html.escape(one.note[0].upper() + one.note[1:])}.</p>"
    head = ["Measure", one.a, one.b, "Difference [95 % CI]", "Hedges' g [95 % CI]", "p", "p (all)"]
    margin = next((e.margin for e in one.effects.values() if math.isfinite(e.margin)), None)
    head += [] if margin is None else ["p (equivalent)"]
    rows: list[str] = []
    region = ""
    for key, effect in one.effects.items():
        own = key.rpartition(".")[0]
        if own != region:
            rows.append(group_row(html.escape(own.replace("_", " ").capitalize()), len(head)))
            region = own
        rows.append(row(html.escape(titled(*_short_title(key))), _cells(effect, _title(key)[2])))
    return (
        table(f"Effects, {html.escape(one.a)} and {html.escape(one.b)}", _caption(one), map(html.escape, head), rows)
        + _any_difference(one)
        + _clusters(one)
    )


def _short_title(key: str) -> tuple[str, str]:
    """Title without the region, which heads its rows, and unit."""
    title, unit, _ = _title(key)
    short = title.partition(": ")[2]
    return (short[0].upper() + short[1:] if short and "." in key else title), unit


def _caption(one: Comparison) -> str:
    n = next(iter(one.effects.values())).n_a if one.effects else 0
    how = f"{len(one.curves[0]) if one.curves else n} pairs" if one.paired else "independent samples"
    a = html.escape(one.a)
    b = html.escape(one.b)
    pairs = len(one.levels) * (len(one.levels) - 1) // 2
    family = (
        f"all measures of this table and all {pairs} pairs of {html.escape(one.factor)}"
        if pairs > 1
        else ("all measures of this table")
    )
    adjusted = f", adjusted for {html.escape(' and '.join(one.covariates))}" if one.covariates else ""
    equal = (
        ". p (equivalent): two one-sided tests of the stated margin"
        if any(math.isfinite(e.margin) for e in one.effects.values())
        else ""
    )
    return (
        f"Participants' means over steps, feet and recordings; {how}. Difference and Hedges' g are {b} less {a}"
        f"{adjusted}, with 95 % confidence intervals. p by permutation; p (all) allows for {family} (largest |t|)"
        f"{equal}."
    )


def _any_difference(one: Comparison) -> str:
    """Of three levels or more, the measures in which any of them differ; shown with the first pair."""
    if not one.omnibus or (one.a, one.b) != tuple(one.levels[:2]):
        return ""
    found = {key: test for key, test in one.omnibus.items() if test.p_all < 0.05}
    names = html.escape(", ".join(one.levels))
    if not found:
        return f"<p>Of {names} together no measure differs (largest F of all {len(one.omnibus)} measures).</p>"
    rows = [
        row(
            html.escape(full_title(key)),
            [f"F({t.freedom[0]}, {t.freedom[1]}) = {number(t.f)}", probability(t.p), probability(t.p_all)],
        )
        for key, t in found.items()
    ]
    caption = f"Measures in which any of {names} differ; p (all) allows for all {len(one.omnibus)} measures."
    return table(f"Any difference, {html.escape(one.factor)}", caption, ("Measure", "F", "p", "p (all)"), rows)


def _cells(effect: Effect, factor: float) -> list[str]:
    def text(value: float, digits: int = 3) -> str:
        return number(scaled(value, 1.0) if value == value else None, digits)

    low = text(effect.low * factor)
    high = text(effect.high * factor)
    return [
        text(effect.mean_a * factor),
        text(effect.mean_b * factor),
        f"{text(effect.difference * factor)} [{low},\u00a0{high}]",
        f"{text(effect.effect_size, 2)} [{text(effect.effect_low, 2)},\u00a0{text(effect.effect_high, 2)}]",
        probability(effect.p),
        f"<strong>{probability(effect.p_all)}</strong>" if effect.p_all < 0.05 else probability(effect.p_all),
        *([probability(effect.p_equivalent)] if math.isfinite(effect.margin) else []),
    ]


def _clusters(one: Comparison) -> str:
    lines = []
    if one.curve_test is not None:
        for n, p in enumerate(one.curve_test.cluster_p, 1):
            places = (one.curve_test.clusters == n).nonzero()[0]
            if p <= 0.05:
                lines.append(f"Force differs from {places[0]} to {places[-1]} % of the stance (p = {p:.3g}).")
        if not lines:
            lines.append("The force curves differ nowhere (largest cluster, p above 0.05).")
    if one.map_test is not None:
        kept = sum(p <= 0.05 for p in one.map_test.cluster_p)
        share = 100.0 * float(one.map_test.significant.mean())
        where = f"in {kept} area{'s' if kept != 1 else ''}, {share:.0f} % of the sole" if kept else "nowhere"
        lines.append(f"The pressure maps differ {where} (largest cluster of {one.map_test.permutations} permutations).")
    return "".join(f"<p>{line}</p>" for line in lines)


def _reliability(reliability: Mapping[str, Mapping[str, Reliability]]) -> str:
    out = ""
    for condition, measures in reliability.items():
        rows = []
        for key, r in measures.items():
            title, unit, factor = _title(key)
            icc = (
                f"{_share(v)} [{_share(a)},\u00a0{_share(b)}]"
                for v, a, b in ((r.icc_2_1, r.icc_2_1_low, r.icc_2_1_high), (r.icc_2_k, r.icc_2_k_low, r.icc_2_k_high))
            )
            cells = [number(r.mean * factor), *icc, number(r.sem * factor), number(r.mdc95 * factor)]
            rows.append(row(html.escape(titled(title, unit)), cells))
        first = next(iter(measures.values()), None)
        if first is None:
            continue
        caption = (
            f"{html.escape(condition)}: {first.k} trials of {first.n} participants. ICC of absolute agreement of one "
            "trial and of the mean of all, SEM of one trial, and the smallest change between two trials that is beyond "
            "error in 95 of 100 people (MDC95)."
        )
        head = ("Measure", "Mean", "ICC(2,1) [95 % CI]", f"ICC(2,{first.k}) [95 % CI]", "SEM", "MDC95")
        out += table(f"Reliability, {html.escape(condition)}", caption, head, rows)
    return out


def _share(value: float) -> str:
    return f"{value:.2f}".replace("-", "−") if math.isfinite(value) else "–"


def _agreement(devices: tuple[str, str], agreement: Mapping[str, Agreement]) -> str:
    rows = []
    for key, a in agreement.items():
        title, unit, factor = _title(key)
        bias, low, high, least, most = (number(v * factor) for v in (a.bias, a.bias_low, a.bias_high, a.low, a.high))
        cells = [
            f"{bias} [{low},\u00a0{high}]",
            least,
            most,
            probability(a.slope_p),
        ]
        rows.append(row(html.escape(titled(title, unit)), cells))
    first = next(iter(agreement.values()))
    one, other = map(html.escape, devices)
    caption = (
        f"{other} less {one}, {first.pairs} pairs of {first.people} participants (Bland &amp; Altman). p of slope: "
        "whether the difference grows with the size."
    )
    head = ("Measure", "Bias [95 % CI]", "Lower limit of agreement", "Upper limit", "p of slope")
    return table("Agreement of devices", caption, head, rows)


def _mixed(mixed: Sequence[MixedEffect]) -> str:
    rows = []
    for e in mixed:
        title, unit, factor = _title(e.measure)
        difference, low, high = (number(v * factor) for v in (e.difference, e.low, e.high))
        spreads = [number(v * factor) for v in (e.sd_people, e.sd_levels, e.sd_steps)]
        cells = [
            html.escape(f"{e.b} less {e.a}"),
            f"{difference} [{low},\u00a0{high}]",
            probability(e.p),
            *spreads,
            html.escape(e.note),
        ]
        rows.append(row(html.escape(titled(title, unit)), cells))
    caption = (
        f"Linear mixed models of {mixed[0].steps} single steps of {mixed[0].people} people (REML, by statsmodels), "
        "with a constant for each person and for each person in each level. p is of z and of each measure alone."
    )
    head = ("Measure", "Levels", "Difference [95 % CI]", "p", "SD of people", "SD of levels", "SD of steps", "Note")
    return table("Mixed models", caption, head, rows, words=("Levels", "Note"))


def _look(summary: Mapping[str, Any]) -> str:
    errors = [f"{file}: {why}" for file, why in summary["errors"].items()]
    parts = [f"<h3>Not measured</h3>{warning_list(errors)}" if errors else "<p>Every recording was measured.</p>"]
    rows = [
        row(
            html.escape(o["participant"]),
            [
                html.escape(o["condition"]),
                titled(*_title(o["key"])[:2]),
                number(o["value"] * _title(o["key"])[2]),
                number(o["median"] * _title(o["key"])[2]),
            ],
        )
        for o in summary["outliers"][:_MOST]
    ]
    if rows:
        caption = "More than 3.5 robust standard deviations from the median of the condition. They are in all results."
        head = ("Participant", "Condition", "Measure", "Value", "Median of the condition")
        parts.append(table("Outliers", caption, head, rows, words=head[1:3]))
    else:
        parts.append("<p>No participant is far from the others of the condition.</p>")
    return "".join(parts)


def _recordings(results: Sequence[RecordingResult]) -> str:
    rows = []
    for result in results[:_MOST]:
        counts = {side: int(foot["steps"]) for side, foot in result.feet.items()}
        few = [side for side, count in counts.items() if count < FEWEST_STEPS]
        note = result.error or (f"fewer than {FEWEST_STEPS} steps: {', '.join(few)}" if few else "")
        rows.append(
            row(
                html.escape(result.who.file),
                [
                    html.escape(result.who.participant),
                    html.escape(result.who.condition),
                    html.escape(result.format),
                    ", ".join(f"{side} {count}" for side, count in counts.items()),
                    html.escape(note),
                ],
            )
        )
    more = "" if len(results) <= _MOST else f" The first {_MOST} of {len(results)}; recordings.csv has all."
    head = ("Recording", "Participant", "Condition", "Format", "Steps in the means", "Note")
    return table("Recordings", f"One row a recording.{more}", head, rows, words=head[1:])


_MOST_REGIONS = 12  # Measures of regions that a figure of effects shows: those that differ
_A = COLOURS["left"]
_B = COLOURS["right"]
_FOUND = "#f2c14e"


def study_figures(comparisons: Sequence[Comparison]) -> list[tuple[str, Any, str]]:
    """Name, figure (None if empty) and caption of the comparisons' figures."""
    out: list[tuple[str, Any, str]] = []
    for count, one in enumerate(comparisons, 1):
        end = "" if len(comparisons) == 1 else f"-{count}"
        names = f"{one.a} (A) and {one.b} (B)"
        differs = "where a cluster differs (permutation of the largest cluster, p below 0.05)"
        effects = (
            f"Effect sizes between {names}: Hedges' g with its 95 % confidence interval; filled where p, corrected for "
            "all measures, is below 0.05"
        )
        curves = f"Mean vertical force of {names} over the stance with 95 % confidence bands; shaded {differs}"
        maps = (
            f"Mean maximum pressure pictures of {names} in one frame, their difference B less A, and outlined {differs}"
        )
        out += [
            (f"effects{end}", _draw_effects(one), effects),
            (f"curves{end}", _draw_curves(one), curves),
            (f"maps{end}", _draw_maps(one), maps),
        ]
    return out


def _draw_effects(one: Comparison) -> Any | None:
    finite = [(key, e) for key, e in one.effects.items() if np.isfinite(e.effect_size)]
    own = sorted((pair for pair in finite if "." in pair[0] and pair[1].p_all < 0.05), key=lambda pair: pair[1].p_all)
    known = [pair for pair in finite if "." not in pair[0]] + own[:_MOST_REGIONS]
    if not known:
        return None
    figure, axes = new_figure(7.0, 1.2 + 0.3 * len(known))
    for place, (_, effect) in zip(np.arange(len(known))[::-1], known, strict=True):
        axes.plot([effect.effect_low, effect.effect_high], [place, place], color="#111111", linewidth=1.2)
        face = "#111111" if effect.p_all < 0.05 else "#ffffff"
        axes.plot(effect.effect_size, place, "o", color="#111111", markerfacecolor=face, markersize=6)
    axes.axvline(0.0, color=COLOURS["reference"], linewidth=0.8)
    axes.set_yticks(np.arange(len(known))[::-1], [full_title(key) for key, _ in known])
    axes.set_xlabel(f"Hedges' g: above 0 larger in {one.b}")
    axes.grid(axis="x", alpha=0.3)
    return figure


def _draw_curves(one: Comparison) -> Any | None:
    if one.curves is None or one.curve_test is None:
        return None
    figure, axes = new_figure(7.0, 3.8, grid=True)
    for name, curves, colour, line in ((one.a, one.curves[0], _A, "-"), (one.b, one.curves[1], _B, "--")):
        mean = curves.mean(axis=0)
        reach = student_quantile(0.975, len(curves) - 1) * curves.std(axis=0, ddof=1) / np.sqrt(len(curves))
        axes.fill_between(STANCE, mean - reach, mean + reach, color=colour, alpha=0.2, linewidth=0)
        axes.plot(
            STANCE, mean, line, color=colour, linewidth=1.8, label=f"{drawn_name(name)} ({len(curves)} participants)"
        )
    for cluster, p in enumerate(one.curve_test.cluster_p, 1):
        places = np.flatnonzero(one.curve_test.clusters == cluster)
        if p <= 0.05:
            axes.axvspan(
                STANCE[places[0]], STANCE[places[-1]], color=_FOUND, alpha=0.35, zorder=0, label=f"p = {p:.3g}"
            )
    axes.set(xlabel="stance (%)", ylabel=f"vertical force ({one.curve_unit})")
    axes.legend(fontsize=8, loc="lower center")
    axes.margins(x=0.0)
    return figure


def _draw_maps(one: Comparison) -> Any | None:
    if one.maps is None or one.map_test is None or one.places is None:
        return None
    raw = one.curve_unit == "counts"
    factor, unit = (1.0, "counts") if raw else (1e-3, "kPa")
    a, b = (np.where(one.places, m.mean(axis=0), np.nan) * factor for m in one.maps)
    figure, axes = new_figure(8.0, 4.6, columns=3, sharey=True)
    highest = float(np.nanmax([np.nanmax(a), np.nanmax(b)])) or 1.0
    for panel, name, values in ((axes[0], one.a, a), (axes[1], one.b, b)):
        drawn = panel.imshow(values[:, ::-1], vmin=0.0, vmax=highest, cmap="viridis", **_FRAME)
        panel.set_title(drawn_name(name))
    figure.colorbar(drawn, ax=list(axes[:2]), label=f"maximum pressure ({unit})", shrink=0.8)
    change = b - a
    most = float(np.nanmax(np.abs(change))) or 1.0
    drawn = axes[2].imshow(change[:, ::-1], vmin=-most, vmax=most, cmap="RdBu_r", **_FRAME)
    figure.colorbar(drawn, ax=axes[2], label=f"difference ({unit})", shrink=0.8)
    axes[2].set_title(drawn_name(f"{one.b} less {one.a}"))
    differs = np.zeros(one.places.shape, dtype=bool)
    differs[one.places] = one.map_test.significant
    if differs.any():
        high, wide = one.places.shape
        rows = (np.arange(high) + 0.5) / high
        columns = (np.arange(wide) + 0.5) / wide
        axes[2].contour(columns, rows, differs[:, ::-1].astype(float), levels=[0.5], colors="#111111", linewidths=1.4)
    axes[0].set_ylabel("length of the sole (share), toes up")
    for panel in axes:
        panel.set(xlabel="medial to lateral", xticks=[])
    return figure


# How a map is drawn: heel below, a sole 2.6 times as long as wide.
_FRAME: dict[str, Any] = {"origin": "lower", "extent": (0.0, 1.0, 0.0, 1.0), "aspect": 2.6}
