"""A study's comparisons as a paper's tables in Markdown: means (SD), difference with its interval, effect size, p."""

import math
from collections.abc import Sequence

from plantar.common.pages.page import number, scaled, titled
from plantar.common.version import VERSION
from plantar.gait.analysis.measures import full_title, unit_of
from plantar.gait.analysis.study.compare_conditions import Comparison
from plantar.gait.analysis.study.statistics import Effect


def paper_text(comparisons: Sequence[Comparison]) -> str:
    """Returns a table of each comparison with measures: all of the foot, and those of regions with p (all) up to 0.05.

    Below each stand its methods in words; numbers are those of comparison.csv, rounded.
    """
    parts = [_table(one) for one in comparisons if one.effects]
    return "\n".join(parts) if parts else "No two conditions were compared.\n"


def _table(one: Comparison) -> str:
    first = next(iter(one.effects.values()))
    people = f"n = {first.n_a}" if one.paired else f"n = {first.n_a} and {first.n_b}"
    a, b = (_plain(name) for name in (one.a, one.b))
    head = ("", f"{a}, mean (SD)", f"{b}, mean (SD)", "difference [95 % CI]", "g [95 % CI]", "p", "p (all)")
    rows = [
        (titled(full_title(key), unit_of(key)[0]), *_cells(effect, unit_of(key)[1]))
        for key, effect in one.effects.items()
        if "." not in key or effect.p_all <= 0.05
    ]
    lines = [" | ".join(("", *row, "")).strip() for row in (head, ("---",) * len(head), *rows)]
    return "\n".join(
        [f"**{_plain(one.factor).capitalize()}: {a} and {b}** ({people})", "", *lines, "", _methods(one), ""]
    )


def _cells(effect: Effect, factor: float) -> tuple[str, ...]:
    def text(value: float, digits: int = 3) -> str:
        return number(scaled(value, factor) if math.isfinite(value) else None, digits)

    def plain(value: float) -> str:
        return number(value if math.isfinite(value) else None, 2)

    return (
        f"{text(effect.mean_a)} ({text(effect.sd_a, 2)})",
        f"{text(effect.mean_b)} ({text(effect.sd_b, 2)})",
        f"{text(effect.difference)} [{text(effect.low)}, {text(effect.high)}]",
        f"{plain(effect.effect_size)} [{plain(effect.effect_low)}, {plain(effect.effect_high)}]",
        _probability(effect.p),
        _probability(effect.p_all),
    )


def _methods(one: Comparison) -> str:
    people = "within participants" if one.paired else "between participants"
    pairs = len(one.levels) * (len(one.levels) - 1) // 2
    family = f"all {len(one.effects)} measures" + (f" and {pairs} pairs" if pairs > 1 else "")
    allowed = f", adjusted for {_plain(' and '.join(one.covariates))}" if one.covariates else ""
    return (
        f"Means of participants over steps, feet and recordings. Differences are {_plain(one.b)} less {_plain(one.a)}, "
        f"{people}{allowed}; g is Hedges' g; p by permutation, p (all) of the largest |t| of {family} (Westfall & "
        f"Young 1993). Plantar {VERSION}."
    )


def _probability(p: float) -> str:
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def _plain(text: str) -> str:
    """A name without what Markdown takes for its own."""
    return text.replace("|", "/").replace("*", "").replace("\n", " ")
