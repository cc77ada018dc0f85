"""What an earlier analysis left in an output folder, where it may be of another person."""

import os
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from plantar.common.pages.folder_page import INDEX

_RESULTS = ("metrics.json", "comparison.json", "day.json")
_TABLES = ("steps.csv", "regions.csv", "footprints.csv", "bouts.csv", "hours.csv")
_PAGES = (INDEX, "report.html", "summary.html", "day.html")
_FIGURES = ("pressure", "regions", "force", "steps", "symmetry", "wrench", "summary", "footprint", "difference", "day")
PRODUCTS = {*_RESULTS, *_TABLES, *_PAGES} | {f"{name}{suffix}" for name in _FIGURES for suffix in (".png", ".svg")}
"""Files that the analysis of a recording, a comparison or a day writes, where the recording allows them."""


def earlier_output(folder: str | os.PathLike[str]) -> list[Path]:
    """Files of an earlier analysis in a folder, and in those of a comparison's two; none without its results.

    What it exported bears the recording's name, and is not among them.
    """
    top = Path(folder)
    if not any((top / name).is_file() for name in _RESULTS):
        return []
    folders = [top, top / "a", top / "b"] if (top / "comparison.json").is_file() else [top]
    return [path for each in folders for name in sorted(PRODUCTS) if (path := each / name).is_file()]


def remove_earlier(earlier: Iterable[Path], keep: Iterable[str | os.PathLike[str] | None]) -> None:
    """Remove earlier files other than those to keep, and a comparison's folders that are empty then."""
    kept = {os.path.realpath(path) for path in keep if path is not None}
    for path in earlier:
        if os.path.realpath(path) not in kept:
            path.unlink(missing_ok=True)
            if path.parent.name in ("a", "b"):
                with suppress(OSError):  # of what else is in it
                    path.parent.rmdir()
