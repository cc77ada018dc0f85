"""The page of a study: its recordings, differences between conditions, and outliers."""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from plantar.gait.analysis.measures import MEASURES, full_title
from plantar.gait.analysis.steps.steady import FEWEST_STEPS
from plantar.gait.analysis.study.compare_conditions import Comparison
from plantar.gait.analysis.study.one_recording import RecordingResult
from plantar.gait.analysis.study.statistics import Effect
from plantar.pages.page import Section, figures_of, number, page, row, scaled, table, titled, warning_list

__all__ = ["study_page"]

_MOST = 200
"""Rows of a table that the page shows; the CSV tables hold all."""


def study_page(
    summary: Mapping[str, Any],
    results: Sequence[RecordingResult],
    comparisons: Sequence[Comparison],
    figures: Sequence[tuple[Path, str]],
    name: str,
) -> str:
    """The page as text.

    Args:
        summary: Result of `Study.summary`.
        results: The recordings.
        comparisons: Every two conditions.
        figures: PNG files to embed, with captions.
        name: Name of the study.

    Returns:
        HTML that refers to no other file and no network.
    """
    sections = [Section("summary", "Summary", _summary(summary, comparisons))]
    for i, one in enumerate(comparisons, 1):
        sections.append(Section(f"comparison-{i}", f"{html.escape(one.a)} and {html.escape(one.b)}", _comparison(one)))
    if figures:
        sections.append(figures_of(figures))
    sections.append(Section("look", "To look at", _look(summary)))
    sections.append(Section("recordings", "Recordings", _recordings(results)))
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
    """A comparison's result in words."""
    if one.note:
        return f"{one.a} and {one.b} are not compared: {one.note}."
    sizes = {key: e.effect_size if math.isfinite(e.effect_size) else None for key, e in one.effects.items()}
    found = [(key, e) for key, e in one.effects.items() if e.p_all < 0.05]
    found.sort(key=lambda pair: -abs(sizes[pair[0]] or 0.0))
    how = "the same participants in both" if one.paired else "different participants"
    if not found:
        return f"{one.a} and {one.b} ({how}): no measure differs when all {len(one.effects)} are allowed for."
    named = [f"{_title(key)[0]} ({'+' if e.difference > 0 else '−'}, g = {number(sizes[key], 2)})" for key, e in found]
    more = "" if len(named) <= 4 else f" and {len(named) - 4} more"
    return f"In {one.b} against {one.a} ({how}) these differ: {', '.join(named[:4])}{more}."


def _title(key: str) -> tuple[str, str, float]:
    measure = MEASURES.get(key)
    return full_title(key), measure.unit if measure else "", measure.factor if measure else 1.0


def _comparison(one: Comparison) -> str:
    if one.note:
        return f"<p>{html.escape(one.note[0].upper() + one.note[1:])}.</p>"
    rows = [row(titled(*_title(key)[:2]), _cells(effect, _title(key)[2])) for key, effect in one.effects.items()]
    a, b = html.escape(one.a), html.escape(one.b)
    how = (
        f"{len(one.curves[0]) if one.curves else next(iter(one.effects.values())).n_a} pairs"
        if one.paired
        else "independent samples"
    )
    caption = (
        f"Participants' means over steps, feet and recordings; {how}. Difference and Hedges' g are {b} less {a}, "
        "with 95 % "
        "confidence intervals. p by permutation; p (all) allows for all measures of this table (largest |t|)."
    )
    head = ("Measure", a, b, "Difference [95 % CI]", "Hedges' g [95 % CI]", "p", "p (all)")
    return table(f"Effects, {a} and {b}", caption, head, rows) + _clusters(one)


def _cells(effect: Effect, factor: float) -> list[str]:
    def text(value: float, digits: int = 3) -> str:
        return number(scaled(value, 1.0) if value == value else None, digits)

    low, high = text(effect.low * factor), text(effect.high * factor)
    return [
        text(effect.mean_a * factor),
        text(effect.mean_b * factor),
        f"{text(effect.difference * factor)} [{low},\u00a0{high}]",
        f"{text(effect.effect_size, 2)} [{text(effect.effect_low, 2)},\u00a0{text(effect.effect_high, 2)}]",
        _probability(effect.p),
        f"<strong>{_probability(effect.p_all)}</strong>" if effect.p_all < 0.05 else _probability(effect.p_all),
    ]


def _probability(p: float) -> str:
    return "&lt; 0.001" if p < 0.001 else f"{p:.3f}"


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
