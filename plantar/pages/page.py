"""What every page that is written is made of: its frame, sections, tables and figures, and how numbers are written."""

from __future__ import annotations

import base64
import html
import math
from collections.abc import Iterable, Sequence
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from plantar.pages.policy import with_policy

__all__ = [
    "Section",
    "embedded",
    "figure",
    "figures_of",
    "group_row",
    "number",
    "page",
    "row",
    "scaled",
    "table",
    "titled",
    "warning_list",
]


_WIDE = 1000
"""Width in pixels from which a telephone scrolls a figure sideways, in its frame: fitted, nobody could read it."""


class Section(NamedTuple):
    """One part of a page: the key that links point to, its name, and its HTML."""

    key: str
    name: str
    content: str


def page(title: str, about: str, sections: Sequence[Section], script: str = "", style: str = "") -> str:
    """A whole page that refers to no other file and no network.

    Args:
        title: Its title as plain text.
        about: HTML of what stands under the title: a line, or a list of facts.
        sections: Its parts, which the menu lists.
        script: HTML put at the end.
        style: Its own style sheet, after that of all pages.

    Returns:
        HTML.
    """
    menu = "".join(f'<li><a href="#{key}">{name}</a></li>' for key, name, _ in sections)
    body = "\n".join(
        f'<section aria-labelledby="{key}"><h2 id="{key}" tabindex="-1">{name}</h2>\n{content}</section>'
        for key, name, content in sections
    )
    return with_policy(
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<link rel="icon" href="data:,"><title>{html.escape(title)}</title>'
        f"<style>{_style()}{style}</style></head>\n"
        '<body><a class="skip" href="#content">Skip to content</a>\n'
        f"<header><h1>{html.escape(title)}</h1>{about}"
        f'<nav aria-label="Sections"><ul>{menu}</ul></nav></header>\n'
        f'<main id="content" tabindex="-1">\n{body}\n</main>\n{script}</body></html>\n'
    )


def _style() -> str:
    return files("plantar.pages").joinpath("page.css").read_text(encoding="utf-8")


def figures_of(figures: Iterable[tuple[Path, str]]) -> Section:
    """The section of figures.

    Args:
        figures: PNG files to embed, each with a caption that also serves as its alternative text.
    """
    return Section("figures", "Figures", embedded(figures))


def embedded(figures: Iterable[tuple[Path, str]], names: Sequence[str] | None = None) -> str:
    """Figures that stand in the page itself.

    Args:
        figures: PNG files to embed, each with a caption that also serves as its alternative text.
        names: Names without suffix of those to take; all where None.

    Returns:
        HTML.
    """
    taken = (one for one in figures if names is None or one[0].stem in names)
    return "".join(figure(path.read_bytes(), caption) for path, caption in taken)


def figure(content: bytes, caption: str) -> str:
    """A figure that stands in the page itself.

    Args:
        content: A PNG file's bytes.
        caption: Its caption as plain text, which also serves as its alternative text.

    Returns:
        HTML.
    """
    data, text = base64.b64encode(content).decode(), html.escape(caption)
    width = int.from_bytes(content[16:20], "big")  # of the PNG's first chunk
    wide = f' class="wide" tabindex="0" aria-label="{text}"' if width > _WIDE else ""
    image = f'<img alt="{text}" src="data:image/png;base64,{data}">'
    return f"<figure{wide}>{image}<figcaption>{text}</figcaption></figure>\n"


def warning_list(warnings: Iterable[str]) -> str:
    """Warnings as a list; nothing where there are none."""
    rows = "".join(f"<li>{html.escape(w)}</li>" for w in warnings)
    return f'<ul class="warnings">{rows}</ul>' if rows else ""


def table(label: str, caption: str, head: Iterable[str], rows: Iterable[str], words: Iterable[str] = ()) -> str:
    """A table that scrolls by itself where the page is narrow.

    Args:
        label: Its name for screen readers.
        caption: HTML of its caption.
        head: HTML of each column's head.
        rows: What `row` and `group_row` give.
        words: Heads of the columns that hold words, which begin at the left; numbers end at the right.

    Returns:
        HTML.
    """
    heads, left = list(head), set(words)
    names = "".join(f'<th scope="col">{name}</th>' for name in heads)
    aligned = " ".join(f"words-{i}" for i, name in enumerate(heads, start=1) if name in left)
    kind = f' class="{aligned}"' if aligned else ""
    return (
        f'<div class="scroll" tabindex="0" role="region" aria-label="Table: {label}">'
        f"<table{kind}><caption><span>{caption}</span></caption>"
        f"<thead><tr>{names}</tr></thead>"
        f"<tbody>{''.join(rows)}</tbody></table></div>\n"
    )


def row(name: str, cells: Iterable[str]) -> str:
    """A row of a table.

    Args:
        name: What stands at its head.
        cells: HTML of each of its cells.

    Returns:
        The row's HTML.
    """
    return f'<tr><th scope="row">{name}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'


def group_row(name: str, columns: int) -> str:
    """A row that names the rows below it, over all columns.

    Args:
        name: What stands in it.
        columns: Number of the table's columns.

    Returns:
        The row's HTML.
    """
    return f'<tr class="group"><th scope="rowgroup" colspan="{columns}">{name}</th></tr>'


def titled(name: str, unit: str) -> str:
    """A measure's title with its unit, where it has one.

    Args:
        name: Name of the measure.
        unit: Its unit; empty for none.

    Returns:
        The title.

    Example:
        >>> titled("Length", "mm"), titled("Arch index", "")
        ('Length (mm)', 'Arch index')
    """
    return f"{name} ({unit})" if unit else name


def scaled(value: float | None, factor: float) -> float | None:
    """A value in another unit.

    Args:
        value: The value; None stays None.
        factor: Size of its unit in the other unit.

    Returns:
        Their product.
    """
    return None if value is None else value * factor


def number(value: float | None, digits: int = 3) -> str:
    """A value with about as many digits as its size deserves; an en dash where it is not known.

    Args:
        value: The value, or None.
        digits: Digits that count.

    Returns:
        The text.

    Example:
        >>> number(1234.5), number(-0.01234), number(None), number(0.0), number(2.0)
        ('1234', '−0.0123', '–', '0', '2.00')
    """
    if value is None:
        return "–"
    if value == 0.0:
        return "0"
    decimals = min(6, max(0, digits - 1 - math.floor(math.log10(abs(value)))))
    return f"{value:.{decimals}f}".replace("-", "−")
