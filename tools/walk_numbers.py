"""List every number that shapes a walk, with its reason: `python tools/walk_numbers.py [--reason chosen] [--json]`.

The control path is what a tick of the controller imports, directly or not, and what its settings choose by name. A
number is a setting's default, a `fixed` share of the robot's body, a named constant or a literal in a statement. Its
reason stands in the code: in a comment on its line or above it, or in the text below it; or in a docstring around it
(for settings in their entry under "Attributes") by a sentence that names it. The reason begins with one of

    derived:   from what it follows
    nature:    a constant of nature, of floating point, of a norm, or of a paper's equation (T 4.15)
    measured:  what changes where it is 20 % smaller or larger, or the command that shows it
    chosen:    what bounds it, where none of these is known

Separated by rule, since they shape no walk: literals 0, 0.5, 1 and 2; indices, sizes and whole exponents; ranges of
settings; messages, options of decorators, members of enumerations; and `REACHED_ONLY`.
"""

from __future__ import annotations

import argparse
import ast
import json
import re
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import TypeGuard

ROOT = Path(__file__).parents[1]
ENTRIES = ("plantar.gait.controller", "plantar.gait.controller_tables", "plantar.robots.controller_settings")
"""The tick, the parts that settings choose by name, and what a robot and a task make of the settings."""

REACHED_ONLY = {
    "plantar.common.files": "reads files",
    "plantar.common.console": "ends a command",
    "plantar.common.atomic": "writes files",
    "plantar.common.settings.unknown_keys": "words a message",
    "plantar.errors": "words a message",
    "plantar.recordings": "keeps what was",
    "plantar.layouts.calibration": "makes newtons of counts before a tick",
    "plantar.layouts.layout_file": "reads a layout",
    "plantar.layouts.source_pose": "places a layout in a CAD file",
    "plantar.kernels.build_stamp": "checks the build",
    "plantar.robots.biped": "builds the simulator's model",
    "plantar.gait.safety.fault_log": "keeps what was",
    "plantar.gait.safety.bring_up": "moves a robot that hangs, before it walks",
}
"""Modules, and rooms, that a tick imports while no number of theirs shapes a walk."""

REASONS = ("derived", "nature", "measured", "chosen")
_REASON = re.compile(rf"\b({'|'.join(REASONS)}):", re.IGNORECASE)
_BETWEEN = re.compile(rf"\n\s*\n|\n(?= *(?!{'|'.join(REASONS)})\w+: )", re.IGNORECASE)
_FIELDS = ("number", "number_setting", "share", "fixed", "whole")
_WITH_UNIT = 2  # arguments of a setting's field that are its default and its unit
_UNTOLD = (0, 0.5, 1, 2)
_SIZED = (
    "range",
    "slice",
    "zeros",
    "empty",
    "ones",
    "full",
    "reshape",
    "eye",
    "identity",
    "item",
    "array",
    "finite_array",
)
"""Functions whose whole arguments are sizes or positions."""

_ROUNDED = ("round",)
"""Functions whose whole arguments are digits that a log keeps."""

_SHAPED = ("len", "size", "ndim", "shape")
"""What is compared with sizes."""

_ALL_SIZES = ("plantar/kernels/", "plantar/geometry/")
"""Rooms whose whole literals are sizes, positions and counts of corners; what is tuned has a name there."""

_SIZE_NAMES = ("axis", "ndim", "ndmin", "shape", "k", "maxsize", "maxlen")
"""Keywords whose values are sizes or positions."""


@dataclass(frozen=True)
class WalkNumber:
    """One number on the control path.

    Attributes:
        path: File, from the root of the repository.
        line: Where it is.
        kind: "setting", "fixed", "name" or "literal".
        name: Its name, or the expression that holds a literal.
        value: As it is written.
        unit: As far as the code states one; empty otherwise.
        reason: One of `REASONS`; empty where the code gives none.
        words: The reason's text.
    """

    path: str
    line: int
    kind: str
    name: str
    value: str
    unit: str
    reason: str
    words: str


def control_path(root: Path = ROOT, entries: Sequence[str] = ENTRIES) -> dict[str, Path]:
    """Modules that some modules import, directly or not, themselves included, by name.

    Args:
        root: Folder that holds their package.
        entries: Names of the modules to start from.
    """
    found: dict[str, Path] = {}
    left = list(entries)
    while left:
        module = left.pop()
        if module in found or any(_lies_in(module, room) for room in REACHED_ONLY):
            continue
        path = _file_of(root, module)
        if path is not None:
            found[module] = path
            left += _imported(_parsed(path.read_text()), module, path.name == "__init__.py")
    return dict(sorted(found.items()))


def numbers_on(root: Path = ROOT, entries: Sequence[str] = ENTRIES) -> list[WalkNumber]:
    """Every number on the control path.

    Args:
        root: Folder that holds the package.
        entries: Names of the modules to start from.
    """
    found = []
    for path in control_path(root, entries).values():
        found += numbers_in(path.read_text(), str(path.relative_to(root)))
    return found


def numbers_in(source: str, path: str) -> list[WalkNumber]:
    """The numbers of one file.

    Args:
        source: Its text.
        path: Its name, for the list.
    """
    return list(_File(source, path).numbers())


def _lies_in(module: str, room: str) -> bool:
    return module == room or module.startswith(f"{room}.")


def _file_of(root: Path, module: str) -> Path | None:
    path = root / module.replace(".", "/")
    for file in (path / "__init__.py", path.with_suffix(".py")):
        if file.exists():
            return file
    return None


def _imported(tree: ast.Module, module: str, is_package: bool) -> Iterator[str]:
    """Modules, and names that may be modules, that a module imports while it runs."""
    package = module if is_package else module.rpartition(".")[0]
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parents = package.split(".")
                base = ".".join([*parents[: len(parents) - node.level + 1], *([base] if base else [])])
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


def _statements(node: ast.AST) -> Iterator[ast.stmt]:
    """All statements that run, those inside others too."""
    for field in ("body", "orelse", "finalbody", "handlers", "cases"):
        for inner in getattr(node, field, ()):
            if not _is_for_types(inner):
                if isinstance(inner, ast.stmt):
                    yield inner
                yield from _statements(inner)


def _is_for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and _last_name(node.test) == "TYPE_CHECKING"


@lru_cache(maxsize=512)
def _parsed(source: str) -> ast.Module:
    return ast.parse(source)


def _is_number(node: ast.AST) -> TypeGuard[ast.Constant]:
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


class _File:
    """Reads the numbers of one file."""

    def __init__(self, source: str, path: str) -> None:
        self._path = path
        self._lines = source.splitlines()
        self._tree = _parsed(source)
        self._all_sizes = path.startswith(_ALL_SIZES)
        self._known: dict[ast.AST, list[str]] = {}
        self._named: set[int] = set()

    def numbers(self) -> Iterator[WalkNumber]:
        yield from self._of_body(self._tree.body, (self._tree,))

    def _of_body(self, body: Sequence[ast.stmt], around: tuple[ast.AST, ...]) -> Iterator[WalkNumber]:
        named = isinstance(around[-1], ast.Module | ast.ClassDef)
        for index, statement in enumerate(body):
            after = body[index + 1] if index + 1 < len(body) else None
            if named and isinstance(statement, ast.Assign | ast.AnnAssign):
                if statement.value is not None:
                    self._named.add(id(statement))
                    yield from self._of_assignment(statement, after, around)
            elif isinstance(statement, ast.ClassDef):
                if not any("Enum" in ast.unparse(base) for base in statement.bases):
                    yield from self._of_body(statement.body, (*around, statement))
            elif isinstance(statement, ast.If) and _is_for_types(statement):
                continue
            else:
                yield from self._of_statement(statement, around)

    def _of_statement(self, statement: ast.stmt, around: tuple[ast.AST, ...]) -> Iterator[WalkNumber]:
        """The literals of a statement's own expressions, then those of the statements inside it."""
        if isinstance(statement, ast.Raise | ast.Assert | ast.Import | ast.ImportFrom):
            return
        inner = (*around, statement) if isinstance(statement, ast.FunctionDef) else around
        if isinstance(statement, ast.FunctionDef):
            heads: list[ast.AST] = [d for d in (*statement.args.defaults, *statement.args.kw_defaults) if d is not None]
        else:
            heads = [child for child in ast.iter_child_nodes(statement) if isinstance(child, ast.expr | ast.withitem)]
        for head in heads:
            for literal, parent in self._literals(head, statement):
                yield self._literal(literal, parent, statement, inner)
        for name in ("body", "orelse", "finalbody"):
            yield from self._of_body(getattr(statement, name, []), inner)
        for handler in getattr(statement, "handlers", []):
            yield from self._of_body(handler.body, inner)
        for case in getattr(statement, "cases", []):
            yield from self._of_body(case.body, inner)

    def _of_assignment(
        self, statement: ast.Assign | ast.AnnAssign, after: ast.stmt | None, around: tuple[ast.AST, ...]
    ) -> Iterator[WalkNumber]:
        """A named constant or a setting's field."""
        value = statement.value
        assert value is not None
        target = statement.target if isinstance(statement, ast.AnnAssign) else statement.targets[0]
        name = ast.unparse(target)
        kind, unit = "name", ""
        if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) and value.func.id in _FIELDS:
            kind = "fixed" if value.func.id == "fixed" else "setting"
            unit = str(getattr(value.args[1], "value", "")) if len(value.args) >= _WITH_UNIT else ""
            value = value.args[0]
        if not any(_is_number(n) and n.value and not self._is_place(n, up) for n, up in _inside(value, statement)):
            return
        close = [*self._comments(statement), _text_of(after)]
        named = re.compile(rf"\A\s*{re.escape(name)}:|`{re.escape(name)}`")
        reason, words = self._reason(close, named, around)
        shown = re.sub(r"\s+", " ", ast.unparse(value))
        yield WalkNumber(self._path, statement.lineno, kind, name, shown, unit, reason, words)

    def _literal(
        self, literal: ast.Constant, parent: ast.AST, statement: ast.stmt, around: tuple[ast.AST, ...]
    ) -> WalkNumber:
        value = self._lines[literal.lineno - 1][literal.col_offset : literal.end_col_offset]
        named = re.compile(rf"(?<![\w.]){re.escape(value)}(?!\w|\.\w)")
        reason, words = self._reason(self._comments(statement), named, around)
        shown = re.sub(r"\s+", " ", ast.unparse(parent))
        return WalkNumber(self._path, literal.lineno, "literal", shown, value, "", reason, words)

    def _reason(self, close: Sequence[str], named: re.Pattern[str], around: tuple[ast.AST, ...]) -> tuple[str, str]:
        """The nearest reason, and its words: of what stands beside a number, or of a docstring that names it."""
        for text in close:
            match = _REASON.search(text)
            if match is not None:
                return match[1].lower(), " ".join(text[match.start() :].split())
        for node in reversed(around):
            for paragraph in self._paragraphs(node):
                match = _REASON.search(paragraph)
                if match is not None and named.search(paragraph):
                    return match[1].lower(), " ".join(paragraph[match.start() :].split())
        return "", ""

    def _paragraphs(self, node: ast.AST) -> list[str]:
        """Paragraphs, and entries such as those under "Attributes", of a docstring."""
        if node not in self._known:
            text = ast.get_docstring(node) or ""  # type: ignore[arg-type]
            self._known[node] = _BETWEEN.split(text)
        return self._known[node]

    def _comments(self, statement: ast.stmt) -> list[str]:
        """The comment on a statement's own lines, and the one directly above it."""
        body = getattr(statement, "body", None)
        last = body[0].lineno - 1 if body else statement.end_lineno or statement.lineno
        first = statement.lineno
        own = [_comment_of(line) for line in self._lines[first - 1 : max(first, last)]]
        above: list[str] = []
        while first > 1 and self._lines[first - 2].lstrip().startswith("#"):
            first -= 1
            above.insert(0, _comment_of(self._lines[first - 1]))
        return [" ".join(filter(None, own)), " ".join(above)]

    def _literals(self, node: ast.AST, statement: ast.stmt) -> Iterator[tuple[ast.Constant, ast.AST]]:
        """Literals of an expression that need a reason, each with the expression that it stands in."""
        for this, up in _inside(node, statement):
            if not _is_number(this) or this.value in _UNTOLD:
                continue
            if not self._is_place(this, up):
                near = [part for part in up if isinstance(part, ast.BinOp | ast.Compare | ast.Call | ast.Tuple)]
                yield this, near[-1] if near else this

    def _is_place(self, number: ast.AST, up: tuple[ast.AST, ...]) -> bool:
        """Whether a number is an index, a size, a whole exponent, or part of a message."""
        whole = type(getattr(number, "value", None)) is int
        if whole and self._all_sizes and id(up[0]) not in self._named:
            return True
        for inner, outer in zip((*up[1:], number), up, strict=True):
            if isinstance(outer, ast.JoinedStr) or (whole and _holds_sizes(outer, inner)):
                return True
        return False


def _holds_sizes(outer: ast.AST, inner: ast.AST) -> bool:
    """Whether an expression takes whole numbers in a part of it for indices, sizes, exponents or digits."""
    if isinstance(outer, ast.Subscript):
        return inner is outer.slice
    if isinstance(outer, ast.keyword):
        return outer.arg in _SIZE_NAMES
    if isinstance(outer, ast.Call):
        return inner is not outer.func and _last_name(outer.func) in (*_SIZED, *_ROUNDED)
    if isinstance(outer, ast.BinOp):
        return isinstance(outer.op, ast.Pow) and inner is outer.right
    if isinstance(outer, ast.Compare):
        sides = (outer.left, *outer.comparators)
        return any(_last_name(part.func if isinstance(part, ast.Call) else part) in _SHAPED for part in sides)
    return False


def _text_of(statement: ast.stmt | None) -> str:
    """The text below a constant; empty where another statement follows."""
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
        return str(statement.value.value)
    return ""


def _comment_of(line: str) -> str:
    """A line's comment without its mark; empty without one."""
    quote = ""
    for index, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        elif letter == "#":
            return line[index + 1 :].strip()
    return ""


def _inside(node: ast.AST, above: ast.AST) -> Iterator[tuple[ast.AST, tuple[ast.AST, ...]]]:
    """All nodes of an expression, each with those around it, the nearest last."""
    left: list[tuple[ast.AST, tuple[ast.AST, ...]]] = [(node, (above,))]
    while left:
        this, up = left.pop()
        yield this, up
        left += [(child, (*up, this)) for child in ast.iter_child_nodes(this)]


def _last_name(node: ast.AST) -> str:
    return getattr(node, "attr", getattr(node, "id", ""))


def listed(numbers: Sequence[WalkNumber]) -> str:
    """Numbers as lines: place, name, value, unit and reason."""
    lines = []
    for n in numbers:
        value = f" = {n.value} {n.unit}".rstrip() if n.kind != "literal" else f" in {n.name}"
        name = n.name if n.kind != "literal" else n.value
        lines.append(f"{n.path}:{n.line}  {n.kind} {name}{value}\n    {n.words or 'NO REASON'}")
    return "\n".join(lines)


def counted(numbers: Sequence[WalkNumber]) -> Mapping[str, int]:
    """How many numbers there are of each reason."""
    found = Counter(n.reason or "none" for n in numbers)
    return {reason: found[reason] for reason in (*REASONS, "none")}


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the list; returns 1 where a number has no reason.

    Args:
        arguments: Of the command line.
    """
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--reason", choices=(*REASONS, "none"), help="only numbers with this reason")
    parser.add_argument("--under", default="", help="only files whose path begins so, such as plantar/gait/feet")
    parser.add_argument("--json", action="store_true", help="as JSON")
    told = parser.parse_args(arguments)
    found = numbers_on()
    shown = [n for n in found if n.path.startswith(told.under) and told.reason in (None, n.reason or "none")]
    if told.json:
        print(json.dumps([asdict(n) for n in shown], indent=1))
    else:
        print(listed(shown))
        print(f"{len(found)} numbers: " + ", ".join(f"{count} {name}" for name, count in counted(found).items()))
    return 1 if any(not n.reason for n in found) else 0


if __name__ == "__main__":
    sys.exit(main())
