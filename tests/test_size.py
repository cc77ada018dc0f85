"""The source does not grow unnoticed: lines, statements and words of docstrings have limits, which only go down.

Where a change needs more, something else in the same rooms becomes shorter; where a limit can be
lowered, lower it.
"""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FILES = sorted((ROOT / "plantar").rglob("*.py"))

LIMITS = {"lines": 96_341, "statements": 58_111, "docstring words": 112_682, "lines of a file": 450}
"""What the source has at most; `.pxd` files count as lines. Wanted: 80,000, 48,000, 120,000 and 450 (reached)."""


def test_the_source_keeps_its_size():
    texts = {path: path.read_text(encoding="utf-8") for path in FILES}
    trees = [ast.parse(text) for text in texts.values()]
    types = sum(path.read_text(encoding="utf-8").count("\n") for path in (ROOT / "plantar").rglob("*.pxd"))
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
    nodes = [node for tree in trees for node in ast.walk(tree)]
    found = {
        "lines": sum(text.count("\n") for text in texts.values()) + types,
        "statements": sum(isinstance(node, ast.stmt) for node in nodes),
        "docstring words": sum(len((ast.get_docstring(n) or "").split()) for n in nodes if isinstance(n, documented)),
        "lines of a file": max(text.count("\n") for text in texts.values()),
    }
    assert {name: count for name, count in found.items() if count > LIMITS[name]} == {}
