"""Figures of a report, and their files."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from plantar.common.sides import Side
from plantar.gait.analysis.pages.force_figures import figure_force, figure_steps, figure_symmetry, figure_wrench
from plantar.gait.analysis.pages.sole_figures import figure_pressure, figure_regions
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.summary import symmetry
from plantar.plotting import save_figure
from plantar.recordings.pressure_recording import PressureRecording


def write_figures(
    figures: Sequence[tuple[str, Any, str]], folder: Path, progress: Callable[[float, str], None] | None = None
) -> list[tuple[Path, str]]:
    """Write figures (name, figure or None without data, caption) as PNG and SVG in a folder.

    Returns the PNG files with captions. `progress` is called with a share 0..1 and the work.
    """
    report = progress or (lambda fraction, text: None)
    written: list[tuple[Path, str]] = []
    for i, (name, figure, caption) in enumerate(figures):
        if figure is not None:
            written.append((save_figure(figure, folder / f"{name}.png"), caption))
            # The axes stay where they are: placing them takes as long as drawing. And with any engine, even "none",
            # matplotlib draws a figure once more before it saves it.
            figure.set_layout_engine(None)
            save_figure(figure, folder / f"{name}.svg")
        report((i + 1) / (len(figures) + 2), "drawing")
    return written


def draw_figures(
    recording: PressureRecording,
    feet: Mapping[Side, FootGait],
    folder: Path,
    progress: Callable[[float, str], None] | None = None,
) -> list[tuple[Path, str]]:
    """Returns PNG files with captions of figures of a recording's feet, drawn as PNG and SVG in a folder; calls
    progress.
    """
    figures = (
        (
            "pressure",
            figure_pressure(recording, feet),
            "Maximum pressure picture of each foot and CoP path of each step; grey cells were never loaded",
        ),
        ("regions", figure_regions(recording, feet), "Regions of each foot, its axis, and the thirds of its print"),
        ("force", figure_force(recording, feet), "Vertical force of each foot over time with its events"),
        ("steps", figure_steps(recording, feet), "Vertical force over the stance of the steps, mean and ± 1 SD"),
        (
            "symmetry",
            figure_symmetry(symmetry(feet)),
            "Symmetry index of the main measures: the bars point to the foot whose value is larger",
        ),
        ("wrench", figure_wrench(recording, feet), "Wrench of the ground on each sole over time"),
    )
    return write_figures(figures, folder, progress)
