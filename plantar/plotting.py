"""The only module that imports matplotlib: how figures are made, styled and saved.

Other modules ask `new_figure` for axes, draw on them, and hand the figure to `save_figure`. Importing this module is
cheap; matplotlib is loaded by the first figure.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from plantar.atomic import replacing

__all__ = ["COLOURS", "new_figure", "save_figure"]

COLOURS = {
    "left": "#1f6fb4",
    "right": "#d1495b",
    "reference": "#6c757d",
    "truth": "#111111",
    "active": "#f4a259",
    "cell": "#e9ecef",
    "edge": "#868e96",
    "polygon": "#2a9d8f",
}
"""Colours with one meaning each across all figures."""


def new_figure(
    width: float = 8.0, height: float = 5.0, rows: int = 1, columns: int = 1, **options: Any
) -> tuple[Any, Any]:
    """Make a figure with axes, without a display.

    Args:
        width: Width in inches.
        height: Height in inches.
        rows: Rows of axes.
        columns: Columns of axes.
        options: Passed to `Figure.subplots`, for example `sharex=True` or `squeeze=False`.

    Returns:
        The matplotlib figure and its axes (an array where there are several).
    """
    from matplotlib.figure import Figure  # 0.3 s: only where something is drawn

    figure = Figure(figsize=(width, height), layout="constrained", dpi=130)
    axes = figure.subplots(rows, columns, **options)
    return figure, axes


def save_figure(figure: Any, path: str | os.PathLike[str]) -> Path:
    """Save a figure in the format of the path's suffix (png, svg, pdf); it appears whole or not at all."""
    with replacing(path) as temporary:
        # No date and fixed ids: the same figure gives the same bytes.
        metadata = {"Date": None} if temporary.suffix == ".svg" else None
        figure.savefig(temporary, metadata=metadata)
    return Path(path)
