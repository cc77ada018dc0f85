"""Figures of a study: effect sizes, mean curves and maps, with where they differ."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from plantar.gait.analysis.measures import full_title
from plantar.gait.analysis.pages.force_figures import STANCE
from plantar.gait.analysis.study.compare_conditions import Comparison
from plantar.gait.analysis.study.statistics import student_quantile
from plantar.plotting import COLOURS, new_figure

__all__ = ["study_figures"]

_A, _B, _FOUND = COLOURS["left"], COLOURS["right"], "#f2c14e"


def study_figures(comparisons: Sequence[Comparison]) -> list[tuple[str, Any, str]]:
    """Name, figure (None for nothing to draw) and caption of each figure of the comparisons."""
    out: list[tuple[str, Any, str]] = []
    for number, one in enumerate(comparisons, 1):
        end = "" if len(comparisons) == 1 else f"-{number}"
        names = f"{one.a} (A) and {one.b} (B)"
        out.append(
            (
                f"effects{end}",
                _effects(one),
                f"Effect sizes between {names}: Hedges' g with its 95 % confidence interval; filled where p, "
                "corrected for all "
                "measures, is below 0.05",
            )
        )
        out.append(
            (
                f"curves{end}",
                _curves(one),
                f"Mean vertical force of {names} over the stance with 95 % confidence bands; shaded where a "
                "cluster differs "
                "(permutation of the largest cluster, p below 0.05)",
            )
        )
        out.append(
            (
                f"maps{end}",
                _maps(one),
                f"Mean maximum pressure pictures of {names} in one frame, their difference B less A, and outlined "
                "where a "
                "cluster differs (permutation of the largest cluster, p below 0.05)",
            )
        )
    return out


def _effects(one: Comparison) -> Any | None:
    known = [(key, e) for key, e in one.effects.items() if np.isfinite(e.effect_size)]
    if not known:
        return None
    figure, axes = new_figure(7.0, 1.2 + 0.3 * len(known))
    for place, (_, effect) in zip(np.arange(len(known))[::-1], known, strict=True):
        axes.plot([effect.effect_low, effect.effect_high], [place, place], color="#111111", linewidth=1.2)
        face = "#111111" if effect.p_all < 0.05 else "#ffffff"
        axes.plot(effect.effect_size, place, "o", color="#111111", markerfacecolor=face, markersize=6)
    axes.axvline(0.0, color=COLOURS["reference"], linewidth=0.8)
    titles = [full_title(key) for key, _ in known]
    axes.set_yticks(np.arange(len(known))[::-1], titles)
    axes.set_xlabel(f"Hedges' g: above 0 larger in {one.b}")
    axes.grid(axis="x", alpha=0.3)
    return figure


def _curves(one: Comparison) -> Any | None:
    if one.curves is None or one.curve_test is None:
        return None
    figure, axes = new_figure(7.0, 3.8)
    for name, curves, colour, line in ((one.a, one.curves[0], _A, "-"), (one.b, one.curves[1], _B, "--")):
        mean = curves.mean(axis=0)
        reach = student_quantile(0.975, len(curves) - 1) * curves.std(axis=0, ddof=1) / np.sqrt(len(curves))
        axes.fill_between(STANCE, mean - reach, mean + reach, color=colour, alpha=0.2, linewidth=0)
        axes.plot(STANCE, mean, line, color=colour, linewidth=1.8, label=f"{name} ({len(curves)} participants)")
    for number, p in enumerate(one.curve_test.cluster_p, 1):
        places = np.flatnonzero(one.curve_test.clusters == number)
        if p <= 0.05:
            axes.axvspan(
                STANCE[places[0]], STANCE[places[-1]], color=_FOUND, alpha=0.35, zorder=0, label=f"p = {p:.3g}"
            )
    axes.set_xlabel("stance (%)")
    axes.set_ylabel(f"vertical force ({one.curve_unit})")
    axes.legend(fontsize=8, loc="lower center")
    axes.grid(alpha=0.3)
    axes.margins(x=0.0)
    return figure


def _maps(one: Comparison) -> Any | None:
    if one.maps is None or one.map_test is None or one.places is None:
        return None
    raw = one.curve_unit == "counts"
    factor, unit = (1.0, "counts") if raw else (1e-3, "kPa")
    a, b = (np.where(one.places, m.mean(axis=0), np.nan) * factor for m in one.maps)
    figure, axes = new_figure(8.0, 4.6, columns=3, sharey=True)
    highest = float(np.nanmax([np.nanmax(a), np.nanmax(b)])) or 1.0
    for panel, name, values in ((axes[0], one.a, a), (axes[1], one.b, b)):
        drawn = panel.imshow(values[:, ::-1], vmin=0.0, vmax=highest, cmap="viridis", **_FRAME)
        panel.set_title(name)
    figure.colorbar(drawn, ax=list(axes[:2]), label=f"maximum pressure ({unit})", shrink=0.8)
    change = b - a
    most = float(np.nanmax(np.abs(change))) or 1.0
    drawn = axes[2].imshow(change[:, ::-1], vmin=-most, vmax=most, cmap="RdBu_r", **_FRAME)
    figure.colorbar(drawn, ax=axes[2], label=f"difference ({unit})", shrink=0.8)
    axes[2].set_title(f"{one.b} less {one.a}")
    differs = np.zeros(one.places.shape, dtype=bool)
    differs[one.places] = one.map_test.significant
    if differs.any():
        high, wide = one.places.shape
        rows, columns = (np.arange(high) + 0.5) / high, (np.arange(wide) + 0.5) / wide
        axes[2].contour(columns, rows, differs[:, ::-1].astype(float), levels=[0.5], colors="#111111", linewidths=1.4)
    axes[0].set_ylabel("length of the sole (share), toes up")
    for panel in axes:
        panel.set_xlabel("medial to lateral")
        panel.set_xticks([])
    return figure


_FRAME: dict[str, Any] = {"origin": "lower", "extent": (0.0, 1.0, 0.0, 1.0), "aspect": 2.6}
"""How a map is drawn: heel below, a sole 2.6 times as long as wide."""
