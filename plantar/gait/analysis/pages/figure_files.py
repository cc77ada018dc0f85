"""The files that figures are written to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from plantar.plotting import save_figure

__all__ = ["write_figures"]


def write_figures(
    figures: Sequence[tuple[str, Any, str]], folder: Path, progress: Callable[[float, str], None] | None = None
) -> list[tuple[Path, str]]:
    """Write figures as PNG and SVG.

    Args:
        figures: Name, figure (None for one without data) and caption of each.
        folder: Existing folder to write to.
        progress: Called with a fraction 0..1 and what is being done.

    Returns:
        The PNG files with their captions.
    """
    tell = progress or (lambda fraction, text: None)
    written: list[tuple[Path, str]] = []
    for i, (name, figure, caption) in enumerate(figures):
        if figure is not None:
            written.append((save_figure(figure, folder / f"{name}.png"), caption))
            figure.set_layout_engine("none")  # the axes stay where they are: placing them takes as long as drawing
            save_figure(figure, folder / f"{name}.svg")
        tell((i + 1) / (len(figures) + 2), "drawing")
    return written
