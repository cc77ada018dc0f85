"""Break lines one at a time and see which tests notice: `python tools/mutants.py --sample 40 --seed 7`.

Each mutant is one change of one expression or statement of a room below. Its tests run in a process of their own that
imports the changed module in place of the file; the file itself stays as it is. A mutant that all tests pass survives,
and is listed with its line.
"""

from __future__ import annotations

import argparse
import ast
import copy
import importlib.abc
import importlib.util
import os
import random
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
LONGEST = 300  # s of processor time that the tests of one mutant may take: one that hangs is noticed, too
WAITED = 3600  # s of waiting, in which a busy machine may give less of it: then the campaign stops
MODULE, SOURCE = "PLANTAR_MUTANT_MODULE", "PLANTAR_MUTANT_SOURCE"

_JUDGED = ("verdict", "step_count", "joint_limits", "push_truth", "recovery", "summary_truth")
ROOMS: dict[str, tuple[str, ...]] = {
    "plantar/sim/judging": (
        *(f"tests/sim/judging/test_{name}.py" for name in _JUDGED),
        "tests/robots/test_leg_shapes.py",
    ),
    "plantar/gait/controller.py": (
        "tests/gait/test_controller.py",
        "tests/sim/judging/test_summary_truth.py",
        "tests/sim/run/test_identified.py",
        "tests/sim/run/test_runner.py",
    ),
    "plantar/gait/balance": ("tests/gait/balance", "tests/gait/test_controller.py"),
    "plantar/gait/plan": ("tests/gait/plan", "tests/gait/test_owner.py"),
    "plantar/wholebody/tasks": ("tests/wholebody/tasks", "tests/wholebody/test_properties.py"),
    "plantar/gait/analysis/steps": ("tests/gait/analysis/steps", "tests/gait/analysis/test_closed_forms.py"),
}
"""Files or folders that are broken, and the tests that run where a file's own test notices nothing."""

_OTHER = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
    ast.And: ast.Or,
    ast.Or: ast.And,
}
_SYMMETRIC = ("max", "min", "math.hypot", "math.dist", "np.hypot", "np.maximum", "np.minimum")
"""Functions of which an exchange of the first two arguments is no other program."""

_SIDES = {"left": "right", "right": "left"}


@dataclass(frozen=True)
class Mutant:
    """One change of one file.

    Attributes:
        path: The file, from the root of the repository.
        line: Line that is changed.
        change: What became of what.
        source: The whole changed file.
    """

    path: str
    line: int
    change: str
    source: str


def sites_of(source: str) -> list[tuple[int, int]]:
    """Where a file can be changed: the number of a node, and which of its changes.

    Args:
        source: Its text.
    """
    tree = ast.parse(source)
    alone = set(map(id, _left_alone(tree)))
    nodes = enumerate(ast.walk(tree))
    return [(number, way) for number, node in nodes if id(node) not in alone for way in range(_ways(node))]


def mutant_at(path: str, source: str, site: tuple[int, int]) -> Mutant:
    """One mutant of a file.

    Args:
        path: The file, from the root of the repository.
        source: Its text.
        site: One of `sites_of`.
    """
    tree = ast.parse(source)
    node: Any = list(ast.walk(tree))[site[0]]
    before, line = ast.unparse(node), node.lineno
    after = _change(node, site[1])
    changed = ast.fix_missing_locations(_Replaced(node, after).visit(tree))
    return Mutant(path, line, f"{before[:60]}  ->  {ast.unparse(after)[:60]}", ast.unparse(changed))


def _left_alone(tree: ast.AST) -> Iterator[ast.AST]:
    """Nodes that are no logic: docstrings, annotations, messages of errors, imports, what only types need; and tuned
    values, which are constants of a module and defaults of settings: a test of one would only repeat it."""
    for node in ast.walk(tree):
        roots: list[ast.AST | None] = []
        if isinstance(node, ast.Raise | ast.Import | ast.ImportFrom | ast.JoinedStr | ast.Assert):
            roots = [node]
        elif isinstance(node, ast.FunctionDef):
            arguments = [*node.args.args, *node.args.kwonlyargs, node.args.vararg, node.args.kwarg]
            roots = [node.returns, *node.decorator_list, *(a.annotation for a in arguments if a is not None)]
        elif isinstance(node, ast.AnnAssign):
            roots = [node.annotation]
        elif isinstance(node, ast.Module | ast.ClassDef):
            roots = [line.value for line in node.body if isinstance(line, ast.Assign | ast.AnnAssign)]
            roots += [*node.keywords, *node.decorator_list] if isinstance(node, ast.ClassDef) else []
        elif isinstance(node, ast.Expr | ast.If | ast.Assign) and _is_no_logic(node):
            roots = [node]
        elif isinstance(node, ast.keyword) and node.arg == "strict":  # of zip: a guard, as an assertion
            roots = [node.value]
        for root in roots:
            if root is not None:
                yield from ast.walk(root)


def _is_no_logic(node: ast.Expr | ast.If | ast.Assign) -> bool:
    """Whether a statement is a docstring, for types only, or the list of what a module exports."""
    if isinstance(node, ast.Expr):
        return isinstance(node.value, ast.Constant)
    return ast.unparse(node.test if isinstance(node, ast.If) else node.targets[0]) in ("TYPE_CHECKING", "__all__")


def _ways(node: ast.AST) -> int:
    """How many changes a node has."""
    if isinstance(node, ast.BinOp | ast.BoolOp | ast.AugAssign):
        operator = type(node.op) in _OTHER
        return operator + isinstance(node, ast.AugAssign)
    if isinstance(node, ast.Compare):
        return int(type(node.ops[0]) in _OTHER)
    if isinstance(node, ast.UnaryOp):
        return int(isinstance(node.op, ast.USub | ast.Not))
    if isinstance(node, ast.Constant):
        return int(type(node.value) in (int, float) or node.value in _SIDES or type(node.value) is bool)
    if isinstance(node, ast.Call):
        same = ast.unparse(node.func) in _SYMMETRIC
        return int(len(node.args) > 1 and not same and ast.dump(node.args[0]) != ast.dump(node.args[1]))
    if isinstance(node, ast.Expr):
        return int(isinstance(node.value, ast.Call))
    return 0


def _change(node: ast.AST, way: int) -> ast.AST:
    """What a node becomes; the node itself is not to be used any more."""
    new = copy.deepcopy(node)
    if isinstance(new, ast.AugAssign) and way == int(type(new.op) in _OTHER):
        return ast.Pass()
    if isinstance(new, ast.BinOp | ast.BoolOp | ast.AugAssign):
        new.op = _OTHER[type(new.op)]()
    elif isinstance(new, ast.Compare):
        new.ops[0] = _OTHER[type(new.ops[0])]()
    elif isinstance(new, ast.UnaryOp):
        return new.operand
    elif isinstance(new, ast.Constant):
        new.value = _other_value(new.value)
    elif isinstance(new, ast.Call):
        new.args[0], new.args[1] = new.args[1], new.args[0]
    else:
        return ast.Pass()
    return new


def _other_value(value: object) -> object:
    if isinstance(value, str):
        return _SIDES[value]
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    assert isinstance(value, float)
    return 1.5 * value if value else 1.0


class _Replaced(ast.NodeTransformer):
    """Puts one node in the place of another."""

    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self._old, self._new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        return self._new if node is self._old else super().visit(node)  # type: ignore[no-any-return]


def files_of(room: str) -> list[str]:
    """The files of a room that hold logic, from the root of the repository."""
    path = ROOT / room
    found = [path] if path.is_file() else sorted(path.glob("*.py"))
    return [str(p.relative_to(ROOT)) for p in found if sites_of(p.read_text())]


def sampled(count: int, seed: int) -> list[tuple[str, Mutant]]:
    """A random sample of mutants with their rooms, as many of each room.

    Args:
        count: How many.
        seed: Chooses them.
    """
    chance = random.Random(seed)
    chosen = []
    for number in range(count):
        room = list(ROOMS)[number % len(ROOMS)]
        files = files_of(room)
        sizes = [(ROOT / f).stat().st_size for f in files]
        path = chance.choices(files, sizes)[0]
        source = (ROOT / path).read_text()
        chosen.append((room, mutant_at(path, source, chance.choice(sites_of(source)))))
    return chosen


def tests_of(room: str, path: str) -> list[str]:
    """The tests that should notice a mutant: first the file's own, then the room's."""
    own = ROOT / "tests" / Path(path).relative_to("plantar").parent / f"test_{Path(path).name}"
    tests = [str(own.relative_to(ROOT))] if own.exists() else []
    return tests + [test for test in ROOMS[room] if (ROOT / test).exists() and test not in tests]


def passes(tests: Sequence[str], mutant: Mutant | None = None) -> bool:
    """Whether tests pass, with a mutant or without.

    Args:
        tests: Files or folders of tests.
        mutant: The mutant; None for the code as it is.
    """
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-m", "not long", "-p", "no:cacheprovider", "-p", "mutants"]
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join([str(ROOT), str(ROOT / "tools")]))
    with tempfile.TemporaryDirectory() as folder:
        if mutant is not None:
            source = Path(folder) / "mutant.py"
            source.write_text(mutant.source)
            environment |= {MODULE: mutant.path.removesuffix(".py").replace("/", "."), SOURCE: str(source)}
        ended = subprocess.run(
            [*command, *tests],
            cwd=ROOT,
            env=environment,
            capture_output=True,
            timeout=WAITED,
            check=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST)),
        )
    return ended.returncode == 0


class _Finder(importlib.abc.MetaPathFinder):
    """Imports a mutant in place of its module, in a process of tests."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> object:
        """The mutant where its module is asked for."""
        if name != os.environ[MODULE]:
            return None
        return importlib.util.spec_from_file_location(name, os.environ[SOURCE])


if MODULE in os.environ:
    sys.meta_path.insert(0, _Finder())  # type: ignore[arg-type]


def campaign(count: int, seed: int) -> list[Mutant]:
    """Run the tests of a sample, and print what became of each mutant.

    Args:
        count: How many mutants.
        seed: Chooses them.

    Returns:
        Those that survived.
    """
    survivors, sample = [], sampled(count, seed)
    for room, mutant in sample:
        survived = passes(tests_of(room, mutant.path), mutant)
        print(f"{'SURVIVES' if survived else 'killed  '} {mutant.path}:{mutant.line}  {mutant.change}", flush=True)
        if survived:
            survivors.append(mutant)
    print(f"{count - len(survivors)} of {count} mutants were noticed (seed {seed})")
    return survivors


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sample", type=int, default=40, help="how many mutants")
    parser.add_argument("--seed", type=int, default=0, help="which ones")
    arguments = parser.parse_args()
    sys.exit(1 if campaign(arguments.sample, arguments.seed) else 0)
