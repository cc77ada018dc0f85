"""`index.html` of an output folder: what to open first, and what lies beside it."""

import html
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from urllib.parse import quote

from plantar.common.atomic import write_text
from plantar.common.pages.page import Section, page, row, table
from plantar.common.sides import SIDES

_ABOUT = {
    "report.html": "figures and measures, with a player of the frames",
    "summary.html": "one sheet of the main measures, to print",
    "study.html": "what differs between conditions",
    "patient.html": "one person against the others",
    "view.html": "the walk in 3D",
    "assembly.html": "how the shoe is put together",
    "metrics.json": "every measure, with warnings",
    "steps.csv": "a row a step",
    "regions.csv": "a row a step and region of the foot",
    "recordings.csv": "a row a recording",
    "comparison.csv": "differences between conditions",
    "summary.json": "what the true state shows of the run",
    "check.json": "whether the shoe prints, fits and holds",
    "parts.csv": "what to buy",
    "wiring.csv": "which cell is wired to which",
    "harness.csv": "leads to solder, with pins, colours and lengths",
    "nets.csv": "every pin of every net",
    "pressure.png": "largest pressure on each foot, with the paths of the CoP",
    "regions.png": "regions of each foot",
    "force.png": "force on each foot over time",
    "steps.png": "force of the steps, one over the other",
    "symmetry.png": "left against right",
    "wrench.png": "forces and moments of the soles over time",
    "summary.png": "one sheet of the main measures",
    "run.mcap": "the recording; Foxglove opens it",
}
_BEGINNINGS = {
    "layout": "places and shapes of the taxels",
    "pad": "the soft pad, to cut or print",
    "mould": "mould to cast the pad in",
    "assembly": "print, cells and pad in their places",
    "drawing": "drawing with sizes and tolerances",
    "picture": "the shoe from above, from below and with its pad",
    "cells": "outlines of the cells, to cut or etch",
}
"""Of files whose names end in a side."""
_ENDINGS = {
    ".stl": "mesh to print",
    ".3mf": "mesh to print, with units",
    ".step": "solid for CAD",
    ".pdf": "drawing",
    ".dxf": "drawing for CAD",
    ".png": "picture",
    ".webp": "picture that moves",
    ".mcap": "recording",
}
_GROUPS = (
    ("pages", "Open", (".html",)),
    ("pictures", "Pictures and drawings", (".png", ".webp", ".pdf")),
    ("parts", "To make it", (".stl", ".3mf", ".step", ".dxf", ".kicad_pcb")),
    ("data", "Tables and data", None),
)
INDEX = "index.html"
"""Name of the page."""


def with_folder_page(folder: str | os.PathLike[str], title: str, files: Sequence[str]) -> list[str]:
    """Write the page where there is something to look at; returns the files with it, if written, first.

    Args:
        folder: Output folder.
        title: Heading.
        files: Paths of what was made in the folder, as the command names them.

    Example:
        >>> with_folder_page("out", "a layout", ["out/layout_left.json"])
        ['out/layout_left.json']
    """
    if not any(name.endswith((".html", ".png")) for name in files):
        return list(files)
    target = Path(folder) / INDEX
    others = [name for name in files if Path(name) != target]
    inside = [Path(name).relative_to(folder).as_posix() for name in others]
    write_text(target, page(title, "", list(_sections(inside))))
    return [str(target), *others]


def _sections(files: Sequence[str]) -> Iterable[Section]:
    left = [name for name in files if not _is_twin(name, files)]
    for key, title, endings in _GROUPS:
        own = [name for name in left if endings is None or name.endswith(endings)]
        left = [name for name in left if name not in own]
        if own:
            rows = (
                row(f'<a href="{quote(os.fsencode(name))}">{html.escape(name)}</a>', [_about(name, files)])
                for name in own
            )
            yield Section(key, title, table(title, "", ("file", "what it is"), rows, ("what it is",)))


def _is_twin(name: str, files: Sequence[str]) -> bool:
    """Whether a file is a picture's vector form, which is listed beside it."""
    return name.endswith(".svg") and f"{name[:-4]}.png" in files


def _about(name: str, files: Sequence[str]) -> str:
    path = Path(name)
    known = _ABOUT | {f"{name}_{side}": text for name, text in _BEGINNINGS.items() for side in SIDES}
    text = known.get(path.name, known.get(path.stem, _ENDINGS.get(path.suffix, "")))
    vector = f"{name[:-4]}.svg"
    if path.suffix == ".png" and vector in files:
        return f'{text}, also as <a href="{quote(os.fsencode(vector))}">SVG</a>'
    return text
