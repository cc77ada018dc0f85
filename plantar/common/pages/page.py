"""Parts of written pages: frame, sections, tables, figures and number format."""

import base64
import hashlib
import html
import math
import re
from collections.abc import Iterable, Sequence
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

_WIDE = 1000  # Width in pixels from which a telephone scrolls a figure sideways: fitted, it would be too small to read


class Section(NamedTuple):
    """Page part: link key, name and HTML."""

    key: str
    name: str
    content: str


def page(title: str, about: str, sections: Sequence[Section], script: str = "", style: str = "") -> str:
    """Whole page without other files or network.

    `about`: HTML below the title: a line, or facts; `style`: own style sheet, after the common one.
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
        f"<style>{files('plantar.common.pages').joinpath('page.css').read_text(encoding='utf-8')}{style}</style></head>\n"
        '<body><a class="skip" href="#content">Skip to content</a>\n'
        f"<header><h1>{html.escape(title)}</h1>{about}"
        f'<nav aria-label="Sections"><ul>{menu}</ul></nav></header>\n'
        f'<main id="content" tabindex="-1">\n{body}\n</main>\n{script}</body></html>\n'
    )


def figures_of(figures: Iterable[tuple[Path, str]]) -> Section:
    """Section of figures: PNG files to embed, with plain text captions."""
    return Section("figures", "Figures", embedded(figures))


def embedded(figures: Iterable[tuple[Path, str]], names: Sequence[str] | None = None) -> str:
    """Returns HTML of embedded figures: PNG files with captions, those of the given names (stems), or all."""
    taken = (one for one in figures if names is None or one[0].stem in names)
    return "".join(figure(path.read_bytes(), caption) for path, caption in taken)


def figure(content: bytes, caption: str) -> str:
    """Returns HTML of an embedded figure: content is a PNG's bytes, caption plain text."""
    data = base64.b64encode(content).decode()
    text = html.escape(caption)
    width = int.from_bytes(content[16:20], "big")  # of the PNG's first chunk
    wide = f' class="wide" tabindex="0" aria-label="{text}"' if width > _WIDE else ""
    image = f'<img alt="{text}" src="data:image/png;base64,{data}">'
    return f"<figure{wide}>{image}<figcaption>{text}</figcaption></figure>\n"


def warning_list(warnings: Iterable[str]) -> str:
    """Warnings as a list; empty without any."""
    rows = "".join(f"<li>{html.escape(w)}</li>" for w in warnings)
    return f'<ul class="warnings">{rows}</ul>' if rows else ""


def table(label: str, caption: str, head: Iterable[str], rows: Iterable[str], words: Iterable[str] = ()) -> str:
    """Table that scrolls by itself on narrow pages. `words`: heads of left-aligned word columns; numbers end right."""
    heads = list(head)
    left = set(words)
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
    """Returns HTML of a table row: its name, and HTML cells."""
    return f'<tr><th scope="row">{name}</th>{"".join(f"<td>{cell}</td>" for cell in cells)}</tr>'


def group_row(name: str, columns: int) -> str:
    """Returns HTML of a row with the name of the rows below, over all columns of the table."""
    return f'<tr class="group"><th scope="rowgroup" colspan="{columns}">{name}</th></tr>'


def titled(name: str, unit: str) -> str:
    """Returns measure's name with its unit, if any.

    Example:
        >>> titled("Length", "mm"), titled("Arch index", "")
        ('Length (mm)', 'Arch index')
    """
    return f"{name} ({unit})" if unit else name


def scaled(value: float | None, factor: float) -> float | None:
    """Returns value times a factor; None stays None."""
    return None if value is None else value * factor


def number(value: float | None, digits: int = 3) -> str:
    """Returns value as text with about as many significant digits, or an en dash if None.

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


def probability(p: float) -> str:
    """Returns HTML of a probability, or an en dash if unknown.

    Example:
        >>> probability(0.0312), probability(math.nan)
        ('0.031', '–')
    """
    if not math.isfinite(p):
        return "–"
    return "&lt;\u00a00.001" if p < 0.001 else f"{p:.3f}"


_SCRIPT = re.compile(r"<script(?: type=\"module\")?>(.*?)</script>", re.DOTALL)
_POLICY = (
    "default-src 'none'; base-uri 'none'; form-action 'none'; connect-src 'none'; img-src data: blob:; "
    "style-src 'unsafe-inline'; script-src {}"
)


def with_policy(page: str) -> str:
    """A page (HTML with a `<head>`) with a policy that allows its present scripts, by SHA-256, and no other script,
    request or form.

    Example:
        >>> with_policy("<head></head><p>text</p>")[:90]
        '<head><meta http-equiv="Content-Security-Policy" content="default-src \\'none\\'; base-uri \\'no'
    """
    hashes = [base64.b64encode(hashlib.sha256(code.encode()).digest()).decode() for code in _SCRIPT.findall(page)]
    sources = " ".join(f"'sha256-{value}'" for value in hashes) or "'none'"
    meta = f'<meta http-equiv="Content-Security-Policy" content="{_POLICY.format(sources)}">'
    return page.replace("<head>", f"<head>{meta}", 1)
