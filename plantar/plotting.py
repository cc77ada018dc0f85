"""Only module that imports matplotlib, at the first figure."""

import base64
import html
import io
import os
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import replacing
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout

FORMATS: tuple[str, ...] = ("pdf", "png", "svg")
"""Formats that a figure is saved in, by the suffix of its path."""

COLOURS = {
    "left": "#1f6fb4",
    "right": "#d1495b",
    "reference": "#6c757d",
    "truth": "#111111",
    "active": "#f4a259",
    "cell": "#e9ecef",
    "edge": "#868e96",
    "polygon": "#2a9d8f",
    "cop": "#e4572e",
}
"""Colours with one meaning each across all figures."""


_EDGES: dict[str, Any] = {"edgecolors": "#ffffff", "linewidths": 0.6}


def new_figure(
    width: float = 8.0, height: float = 5.0, rows: int = 1, columns: int = 1, *, grid: bool = False, **options: Any
) -> tuple[Any, Any]:
    """Make a figure with axes, without a display.

    Args:
        width: Width in inches.
        height: Height in inches.
        rows: Rows of axes.
        columns: Columns of axes.
        grid: Draw the ticks' grid, faintly.
        options: Passed to `Figure.subplots`, e.g. `sharex=True` or `squeeze=False`.

    Returns:
        Matplotlib figure and its axes (an array where there are several).
    """
    from matplotlib.figure import Figure  # 0.3 s: only where something is drawn

    figure = Figure(figsize=(width, height), layout="constrained", dpi=130)
    axes = figure.subplots(rows, columns, **options)
    for axis in np.ravel(axes) if grid else ():
        axis.grid(alpha=0.3)
    return figure, axes


def drawn_name(text: str) -> str:
    r"""Text of a file or a user as a figure shows it: in one line, no formula, and no bytes that are no text.

    Example:
        >>> drawn_name("a$x$\n.csv")
        'a\\$x\\$ .csv'
    """
    readable = text.encode("utf-8", errors="replace").decode("utf-8")
    return re.sub(r"[\x00-\x1f\x7f]", " ", readable).replace("$", r"\$")


def save_figure(figure: Any, path: str | os.PathLike[str]) -> Path:
    """Save a figure whole or not at all, reproducibly, in the format of the path's suffix; returns the path.

    Raises:
        InputError: If the suffix is none of FORMATS, or the file cannot be written.
    """
    from matplotlib import rc_context

    final = Path(path)
    suffix = final.suffix[1:].lower()
    if suffix not in FORMATS:
        raise InputError(f"cannot write {final}: unknown figure format {suffix!r}; allowed: {', '.join(FORMATS)}")
    # No date, and ids that do not depend on the process.
    metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(suffix)
    with replacing(final) as temporary, rc_context({"svg.hashsalt": "plantar"}), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # a box is drawn instead
        with _placed(figure, suffix):
            figure.savefig(temporary, metadata=metadata)
    return final


@contextmanager
def _placed(figure: Any, suffix: str) -> Iterator[None]:
    """A figure whose axes are placed, so that saving it draws it once: matplotlib draws it twice with any engine."""
    engine = figure.get_layout_engine()
    if engine is None or suffix != "png":  # other formats measure texts in their own way
        yield
        return
    engine.execute(figure)
    figure.set_layout_engine(None)
    yield
    figure.set_layout_engine(engine)


def draw_cells(axes: Any, layout: SoleLayout, values: NDArray[np.float64], highest: float) -> Any:
    """Draw a sole from above, toes up, its cells coloured by value.

    Args:
        axes: Axes; sole's y to the left.
        layout: Sole, n cells.
        values: Value (n,) of each cell; NaN is drawn empty.
        highest: Upper end of colour scale; its lower end is 0.

    Returns:
        Drawn collection, for a colour bar.
    """
    from matplotlib import colormaps

    cells = _cells(axes, layout, cmap=colormaps["viridis"].with_extremes(bad=COLOURS["cell"]), **_EDGES)
    cells.set_array(np.ma.masked_invalid(values))
    cells.set_clim(0.0, highest if highest > 0.0 else 1.0)
    return cells


def draw_classes(axes: Any, layout: SoleLayout, index: NDArray[np.int64], colours: Sequence[str]) -> Any:
    """Draw a sole from above, toes up, its cells coloured by class.

    `index`: class (n,) of each cell, an index into colours; below 0 is drawn empty. Returns drawn collection.
    """
    faces = [colours[i] if i >= 0 else COLOURS["cell"] for i in index]
    return _cells(axes, layout, facecolors=faces, **_EDGES)


def _cells(axes: Any, layout: SoleLayout, **style: Any) -> Any:
    from matplotlib.collections import PolyCollection

    polygons = [layout.cell_polygon(i)[:, ::-1] * (-1.0, 1.0) for i in range(len(layout))]
    cells = PolyCollection(polygons, **style)
    axes.add_collection(cells)
    ring = np.vstack([layout.outline, layout.outline[:1]])
    axes.plot(-ring[:, 1], ring[:, 0], color=COLOURS["edge"], linewidth=1.0)
    axes.set_aspect("equal")
    axes.autoscale_view()
    ticks_in_mm(axes)
    return cells


def ticks_in_mm(axes: Any) -> None:
    """Label axes in m in whole millimetres, close enough for a foot's width."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    for axis, most in ((axes.xaxis, 5), (axes.yaxis, 8)):
        axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{1e3 * value:.0f}".replace("-", "−")))


def draw_raster(axes: Any, picture: NDArray[np.uint8], pixel: float) -> Any:
    """Draw a picture (h, w, 3) from the axes' origin up, with a pixel size in their unit; returns the drawn image."""
    height, width = picture.shape[:2]
    return axes.imshow(picture, extent=(0.0, width * pixel, 0.0, height * pixel))


def png_of(picture: NDArray[np.float64]) -> bytes:
    """PNG bytes of a picture (height, width, 3), RGB 0..1."""
    from matplotlib.image import imsave

    file = io.BytesIO()
    imsave(file, picture, format="png")
    return file.getvalue()


def html_of(figure: Any, text: str) -> str:
    """A figure with a line of text above it as HTML that needs no other file, for notebooks; None for no figure."""
    if figure is None:
        return f"<p>{html.escape(text)}</p>"
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=90)
    picture = base64.b64encode(file.getvalue()).decode()
    return f'<p>{html.escape(text)}</p><img alt="" src="data:image/png;base64,{picture}">'


def thinned(
    x: NDArray[np.float64], y: NDArray[np.float64], most: int = 6000
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Line x, y with fewer points, about `most`, that looks the same: returns each stretch's extremes; NaN breaks the
    line.
    """
    if len(x) <= most:
        return x, y
    block = -(-2 * len(x) // most)
    starts = np.arange(0, len(y), block)
    stretches = np.full((len(starts), block), np.nan)
    stretches.reshape(-1)[: len(y)] = y
    known = np.isfinite(stretches).any(axis=1)
    low = np.where(np.isnan(stretches), np.inf, stretches).argmin(axis=1)
    high = np.where(np.isnan(stretches), -np.inf, stretches).argmax(axis=1)
    ends = starts[:, None] + np.sort(np.stack([low, high], axis=1), axis=1)
    wanted = np.stack([np.ones_like(known), known & (low != high)], axis=1)
    ends[~known, 0] = starts[~known]
    keep = ends[wanted]
    return x[keep], y[keep]
