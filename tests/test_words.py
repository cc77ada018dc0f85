"""Plain words: how often prose uses words that readers stumble over, and that it does not become more often.

The list is of expressions that engineers do not use of code: a file does not "tell", a sensor does not "feel". Where a
limit can be lowered, lower it.
"""

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

WORDS = re.compile(
    r"\b(?:tell|tells|told|telling|say|says|said|saying|anew|felt|feels|hears?|heard|hearing|shall|whoever|whatever"
    r"|nobody|nowhere|nothing\s+of|likes|whom|thereof|wherein|hereby|besides?|of\s+its\s+own|of\s+one's\s+own"
    r"|goes\s+by|went\s+by|takes\s+for|taken\s+for|is\s+nothing)\b",
    re.I,
)

LIMITS = {"source": 0.7, "docs": 0.35, "changelog": 1.0}
"""Such words in a thousand, at most. Seven other projects have 0.04 to 0.56."""


def prose_of(text: str) -> Iterator[str]:
    """Docstrings and comments of a source file."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            yield ast.get_docstring(node) or ""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.string


def texts(area: str) -> list[str]:
    """The prose of an area."""
    if area == "source":
        files = sorted((ROOT / "plantar").rglob("*.py"))
        return [prose for file in files for prose in prose_of(file.read_text(encoding="utf-8"))]
    if area == "changelog":
        return [(ROOT / "CHANGELOG.md").read_text(encoding="utf-8")]
    pages = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
    return [re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S) for page in pages]


def rate(found: list[str]) -> tuple[float, list[str]]:
    """Such words in a thousand, and each with what is around it."""
    hits = [(text, hit) for text in found for hit in WORDS.finditer(text)]
    count = sum(len(re.findall(r"[A-Za-z']+", text)) for text in found)
    shown = [" ".join(text[max(0, hit.start() - 40) : hit.end() + 40].split()) for text, hit in hits]
    return 1000 * len(hits) / max(count, 1), shown


@pytest.mark.parametrize("area", LIMITS)
def test_prose_is_plain(area):
    found, shown = rate(texts(area))
    assert found <= LIMITS[area], f"{found:.2f} in a thousand, allowed {LIMITS[area]}; for example {shown[:20]}"


def test_the_words_are_found():
    assert rate(["The file tells what nobody felt."]) == (1000 * 3 / 6, ["The file tells what nobody felt."] * 3)
    assert rate(["The file lists what no sensor measured."])[0] == 0.0
