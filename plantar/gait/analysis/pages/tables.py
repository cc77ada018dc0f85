"""Tables of measures: steps, regions, and two recordings."""

import html
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from plantar.common.gravity import GRAVITY
from plantar.common.pages.page import group_row, number, row, scaled, table, titled
from plantar.gait.analysis.masks import SEVEN, TEN
from plantar.gait.analysis.measures import MEASURES, REGION_MEASURES, Measure, full_title, raw_name

EACH_STEP = ("contact_time_s", "stride_time_s", "peak_force_N", "impulse_Ns", "peak_pressure_Pa", "contact_area_m2")
"""Measures that are shown of each step."""

# Forces that are shown in percent of body weight, too.
_OF_BODY_WEIGHT = ("peak_force_N", "first_peak_N", "valley_N", "second_peak_N", "landing_impact_N")
_MOST_STEPS = 80  # Steps that the table shows
# Unit of a measure of raw counts by the end of the key that it has in SI; counts for all others.
_UNITS_OF_COUNTS = {"_Ns": "counts·s", "_Pas": "counts·s", "_N_s": "counts/s", "_Nm": "counts·m"}


class _Shown(NamedTuple):
    key: str
    title: str
    factor: float


def shown_as(key: str, measure: Measure, raw: bool) -> _Shown:
    """Gives key, title and factor of a measure, of counts if raw."""
    if raw and raw_name(key) != key:
        unit = next((u for end, u in _UNITS_OF_COUNTS.items() if key.endswith(end)), "counts")
        return _Shown(raw_name(key), titled(measure.title, unit), 1.0)
    return _Shown(key, titled(measure.title, measure.unit), measure.factor)


def mean_and(spread: Mapping[str, Any] | None, key: str, factor: float) -> str:
    """Returns a spread's mean ± its `key`, times a factor, as text; a dash without one."""
    if spread is None or spread["mean"] is None:
        return "–"
    more = "" if spread.get(key) is None else f"\u00a0±\u00a0{number(spread[key] * factor, 2)}"
    return number(spread["mean"] * factor) + more


def measures_table(metrics: Mapping[str, Any]) -> str:
    """HTML table of each foot's measures, with spread and symmetry."""
    feet: Mapping[str, Any] = metrics["feet"]
    both = len(feet) == 2
    rows = list(filter(None, _rows_of_measures(metrics, both)))
    if not rows:
        return "<p>The recording holds no complete step.</p>"
    head = ["Measure", *(name for side in feet for name in (f"{side}: mean ± SD", "error", "median", "CV (%)"))]
    note = "; symmetry index 100 (L − R) / ((L + R) / 2), 0 is symmetric" if both else ""
    caption = (
        "Over the steps in the means: mean, standard deviation, median, coefficient of variation; error: standard "
        f"error of one step by noise, frames, cells, events, and gains where the layout is calibrated{note}."
    )
    return table("Measures", caption, [*head, "Symmetry index (%)"] if both else head, rows)


def _rows_of_measures(metrics: Mapping[str, Any], both: bool) -> Iterator[str]:
    columns = 4 * len(metrics["feet"]) + 1 + both
    group = ""
    for key, measure in MEASURES.items():
        line = _row_of_measure(metrics, *shown_as(key, measure, bool(metrics.get("raw"))))
        if line and measure.group != group:
            if group == MEASURES["peak_force_N"].group:
                yield from _rows_of_body_weight(metrics, columns)
            group = measure.group
            yield group_row(group, columns)
        yield line


def _row_of_measure(metrics: Mapping[str, Any], key: str, title: str, factor: float) -> str:
    """Empty where no foot has the measure."""
    spreads = [foot["measures"].get(key) for foot in metrics["feet"].values()]
    if all(s is None or s["mean"] is None for s in spreads):
        return ""
    cells = [cell for s in spreads for cell in _spread_cells(s, factor)]
    index = [number(metrics["gait"]["symmetry_percent"].get(key), 2)] if len(spreads) == 2 else []
    return row(title, [*cells, *index])


def _rows_of_body_weight(metrics: Mapping[str, Any], columns: int) -> Iterator[str]:
    weight = metrics["gait"].get("body_weight_N")
    if not weight:
        return
    stated = metrics["subject"]["mass_kg"] is not None
    of = f"{weight / GRAVITY:.3g} kg, {'as stated' if stated else 'which the forces imply'}"
    yield group_row(f"Vertical force, % of body weight ({of})", columns)
    for key in _OF_BODY_WEIGHT:
        yield _row_of_measure(metrics, key, f"{MEASURES[key].title} (% of body weight)", 100.0 / weight)


def _spread_cells(spread: Mapping[str, Any] | None, factor: float) -> tuple[str, str, str, str]:
    if spread is None or spread["mean"] is None:
        return "–", "–", "–", "–"
    return (
        mean_and(spread, "sd", factor),
        number(scaled(spread.get("error"), factor), 2),
        number(scaled(spread.get("median"), factor)),
        number(spread["cv_percent"], 2),
    )


def steps_table(metrics: Mapping[str, Any]) -> str:
    """HTML table of all complete steps in time order; empty without steps."""
    raw = bool(metrics.get("raw"))
    steps = [(side, step) for side, foot in metrics["feet"].items() for step in foot.get("each_step", ())]
    steps.sort(key=lambda one: one[1]["heel_strike_s"])
    if not steps:
        return ""
    shown = [shown_as(key, MEASURES[key], raw) for key in EACH_STEP]
    rows = [
        row(
            f"{side}\u00a0{step['number']}",
            [
                number(step["heel_strike_s"], 4),
                *(number(scaled(step[s.key], s.factor)) for s in shown),
                ("" if step["used"] else "not in the means: ") + html.escape(step["note"]),
            ],
        )
        for side, step in steps[:_MOST_STEPS]
    ]
    more = "" if len(steps) <= _MOST_STEPS else f" The first {_MOST_STEPS} of {len(steps)}; steps.csv has all."
    head = ("Step", "Heel strike (s)", *(s.title for s in shown), "Note")
    return table("Steps", f"The complete steps in the order of time.{more}", head, rows, words=("Note",))


def regions_tables(metrics: Mapping[str, Any]) -> str:
    """HTML table of region means over complete steps, for each foot."""
    shown = [shown_as(key, measure, bool(metrics.get("raw"))) for key, measure in REGION_MEASURES.items()]
    head = ["Region", *(title for _, title, _ in shown)]
    out = ""
    for side, foot in metrics["feet"].items():
        held = {html.escape(_region_title(region)): own for region, own in foot["regions"].items()}
        means = {t: [scaled(own.get(s.key, {}).get("mean"), s.factor) for s in shown] for t, own in held.items()}
        if rows := [row(title, [*map(number, values)]) for title, values in means.items()]:
            out += table(f"Regions of the {side} foot", f"The {side} foot, means over its complete steps.", head, rows)
    return out


def _region_title(region: str) -> str:
    known = dict(SEVEN) | dict(TEN)
    return known.get(region, region.replace("_", " ").capitalize())


def comparison_table(comparison: Mapping[str, Any]) -> str:
    """HTML table of measures that both recordings have."""
    raw = bool(comparison["a"].get("raw") or comparison["b"].get("raw"))
    shown = [shown_as(key, replace(measure, title=full_title(key)), raw) for key, measure in MEASURES.items()]
    rows: list[str] = []
    for side, measures in comparison["difference"].items():
        rows.append(group_row(f"{side.capitalize()} foot", 6))
        rows += [row(title, _pair_cells(measures[key], factor)) for key, title, factor in shown if key in measures]
    if not rows:
        return "<p>The recordings have no foot with complete steps in common.</p>"
    return table(
        "Measures side by side",
        "Over the complete steps. Effect size: B − A over the pooled standard deviation.",
        ("Measure", "A: mean ± SD", "B: mean ± SD", "B − A", "B − A (% of A)", "Effect size (Cohen's d)"),
        rows,
    )


def _pair_cells(pair: Mapping[str, Any], factor: float) -> tuple[str, ...]:
    return (
        mean_and(pair["a"], "sd", factor),
        mean_and(pair["b"], "sd", factor),
        number(pair["difference"] * factor),
        number(pair["percent"], 2),
        number(pair["effect_size"], 2),
    )
