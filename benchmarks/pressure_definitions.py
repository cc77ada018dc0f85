"""Measures compared with those that the R package pressuRe (0.2.4) defines, on recordings of several vendors.

    python benchmarks/pressure_definitions.py RECORDINGS [-o benchmarks/pressure_definitions.md]

pressuRe is not run: its definitions are computed here from the frames: sums times frame time, cells above 0 of a
platform and above 10 kPa of an insole, steps of insoles from 30 N to 30 N.
"""

import argparse
from pathlib import Path

import numpy as np

from plantar.bench.tables import markdown_table
from plantar.errors import PlantarError
from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.gait.analysis.steps.foot_gait import FootGait, Step

FORCE, PRESSURE = 30.0, 10e3
"""pressuRe's force in N between steps of insoles, and the pressure in Pa from which a cell of theirs is loaded."""

ROWS = {
    "peak_force_N": ("peak force, N", 1.0),
    "peak_pressure_Pa": ("peak pressure, kPa", 1e-3),
    "impulse_Ns": ("force-time integral, N s", 1.0),
    "pressure_time_integral_Pas": ("pressure-time integral of peaks, kPa s", 1e-3),
    "pressure_time_integral_cell_Pas": ("pressure-time integral of a cell, kPa s", 1e-3),
    "contact_area_m2": ("contact area at one instant, cm²", 1e4),
    "footprint_area_m2": ("contact area of the step, cm²", 1e4),
    "contact_time_s": ("contact time, s", 1.0),
    "mean_pressure_Pa": ("mean pressure, kPa", 1e-3),
    "cop_path_m": ("CoP path, mm", 1e3),
}
"""Measures that both have: what they are called in the table, and the factor of their unit there."""


def theirs(analysis: Analysis, gait: FootGait, step: Step, between_ours: bool = False) -> dict[str, float] | None:
    """pressuRe's measures of a step, in SI units."""
    platform = analysis.recording.kind == "platform"
    force, pressure, layout = gait.foot.vertical_force, gait.foot.pressure(), gait.foot.layout
    light = np.flatnonzero(force <= (0.0 if platform else FORCE))
    middle = (step.contact.begin + step.contact.end) // 2
    if not (light < middle).any() or not (light > middle).any():
        return None
    begin, end = int(light[light < middle][-1]) + 1, int(light[light > middle][0])
    if between_ours:
        begin, end = step.contact.begin, step.contact.end
    frame, part, load = 1.0 / analysis.recording.rate_hz, pressure[begin:end], force[begin:end]
    cells = part > (0.0 if platform else PRESSURE)
    picture = part.max(axis=0)
    weights = part * layout.areas
    known = weights.sum(axis=1) > 0.0
    path = weights[known] @ layout.positions[:, :2] / weights[known].sum(axis=1, keepdims=True)
    return {
        "peak_force_N": float(load.max()),
        "peak_pressure_Pa": float(part.max()),
        "impulse_Ns": float(load.sum()) * frame,
        "pressure_time_integral_Pas": float(part.max(axis=1).sum()) * frame,
        "pressure_time_integral_cell_Pas": float(part.sum(axis=0).max()) * frame,
        "contact_area_m2": float((cells * layout.areas).sum(axis=1).max()),
        "footprint_area_m2": float(layout.areas[cells.any(axis=0)].sum()),
        "contact_time_s": (end - begin) * frame,
        "mean_pressure_Pa": float(picture[picture > 0.0].mean()),
        "cop_path_m": float(np.hypot(*np.diff(path, axis=0).T).sum()),
    }


def reason(key: str, ours: float, other: float, cut: float, gait: FootGait) -> str:
    """Why a measure differs by more than 1 %: what cutting steps elsewhere makes of it, and the rest."""
    if abs(ours / other - 1.0) <= 0.01:
        return ""
    levels, layout = gait.levels, gait.foot.layout
    least = gait.cell_threshold / layout.areas * 1e-3
    loaded = f"cells count from {least.min():.3g} to {least.max():.3g} kPa on, by the cell"
    rest = {
        "mean_pressure_Pa": "largest of all frames of force over loaded area, not the mean of the picture of maxima",
        "cop_path_m": "averaged over 50 ms, as noise lengthens a path",
        "contact_area_m2": loaded,
        "footprint_area_m2": loaded,
        "contact_time_s": "events between frames",
    }.get(key, "trapezoids: half of the first and of the last frame")
    parts = [
        (cut / other - 1.0, f"steps cut at {levels.release:.0f} and {levels.lift:.0f} N"),
        (ours / cut - 1.0, rest),
    ]
    return "; ".join(f"{100.0 * share:+.1f} %: {text}" for share, text in parts if abs(share) > 0.003)


def rows_of(path: Path) -> list[tuple[str, ...]]:
    analysis, out = analyse(path), []
    for side, gait in analysis.feet.items():
        if gait.foot.layout is None:
            continue
        found = [(step, theirs(analysis, gait, step), theirs(analysis, gait, step, True)) for step in gait.used]
        for key, (title, factor) in ROWS.items():
            known = [(a[key], b[key], c[key]) for a, b, c in found if b is not None and c is not None]
            known = [row for row in known if np.isfinite(row).all()]
            if not known:
                continue
            ours, other, cut = (float(v) for v in np.mean(known, axis=0))
            cells = [path.name, side, str(len(known)), title, *(f"{v * factor:.4g}" for v in (other, cut, ours))]
            cells += [f"{100.0 * (ours / other - 1.0):+.1f} %", reason(key, ours, other, cut, gait)]
            out.append(tuple(cells))
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recordings", type=Path)
    parser.add_argument("-o", type=Path, default=Path(__file__).with_suffix(".md"))
    asked = parser.parse_args()
    rows: list[tuple[str, ...]] = []
    for path in sorted(asked.recordings.iterdir()):
        try:
            rows += rows_of(path)
        except PlantarError:
            continue  # a licence, or a report without frames
    head = ("recording", "foot", "steps", "measure", "pressuRe's")
    lines = [
        "# Measures compared with pressuRe's definitions",
        "",
        "`python benchmarks/pressure_definitions.py RECORDINGS` computes the definitions of the R package pressuRe",
        "(0.2.4) from the frames of each recording; the package is not run. Means over the steps that both have.",
        "For every difference above 1 %, the value with steps cut at our events is listed, and what the rest",
        "comes from.",
        "",
        markdown_table((*head, "between our events", "ours", "difference", "why"), rows),
    ]
    asked.o.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(asked.o)


if __name__ == "__main__":
    main()
