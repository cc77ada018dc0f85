"""What a module offers is there and explained."""

import ast
import importlib
import inspect
import re
from itertools import pairwise
from pathlib import Path

import pytest

from .public_names import defined_names, public_names

ROOT = Path(__file__).resolve().parent.parent
COMMANDS = {*(ROOT / "plantar" / "commands").glob("*.py")}  # their functions are commands, not for import
FILES = sorted({*(ROOT / "plantar").rglob("*.py")} - COMMANDS)
EXPLAINED = ("FORMAT", "COMMAND", "SOURCE", "SINK")  # entries of registries, which their type explains
MODULES = [".".join(p.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__") for p in FILES]

CONSTANT = re.compile(r"[A-Z][A-Z_0-9]+(: [^=]+)? = ")


def undocumented_constants(path: Path) -> list[str]:
    """Public constants that are assigned without a string after them, or a comment at them."""
    text = path.read_text(encoding="utf-8")
    lines, body = text.splitlines(), ast.parse(text).body
    explained = {node.lineno for node, after in pairwise(body) if isinstance(after, ast.Expr)}
    missing = []
    for name, node in defined_names(path).items():
        if isinstance(node, ast.Assign | ast.AnnAssign) and name not in EXPLAINED:
            own = lines[node.lineno - 1 : node.end_lineno]
            first = node.lineno - 1
            while CONSTANT.match(lines[first - 1]):  # constants without a gap share what is said above or below them
                first -= 1
            last = node.end_lineno
            while last < len(lines) and CONSTANT.match(lines[last]):
                last += 1
            commented = any("#" in line for line in own) or lines[first - 1].startswith("#")
            commented = commented or (last < len(lines) and lines[last].startswith('"""'))
            missing += [] if commented or node.lineno in explained else [name]
    return missing


def unexplained(name: str, path: Path) -> list[str]:
    """What a module offers without a word, twice, or in a list alone."""
    module = importlib.import_module(name)
    faults = [] if (module.__doc__ or "").strip() else ["a docstring is missing"]
    if path.name == "__init__.py" and not hasattr(module, "__all__"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        code = [n for n in tree.body if not isinstance(n, ast.Expr)]
        return faults + (["code but no __all__"] if code else [])
    exported = public_names(module)
    faults += ["a name is there twice"] if len(set(exported)) < len(exported) else []
    for n in exported:
        value = getattr(module, n, module)
        named = inspect.isclass(value) or inspect.isfunction(value)
        faults += [f"{n} is not there"] if value is module else []
        faults += [f"{n} has no docstring"] if named and not (inspect.getdoc(value) or "").strip() else []
    return faults + [f"{n} is not explained" for n in undocumented_constants(path)]


def test_what_a_module_offers_is_explained():
    told = {name: faults for name, path in zip(MODULES, FILES, strict=True) if (faults := unexplained(name, path))}
    assert told == {}


def wrongly_listed(name: str, path: Path) -> bool:
    """Whether a list of exports lacks a public definition, or has no name of another module."""
    listed = getattr(importlib.import_module(name), "__all__", None)
    if listed is None:
        return False
    defined = defined_names(path)
    lacks = {n for n, node in defined.items() if not isinstance(node, ast.Assign)} - set(listed)
    passes_on = path.name == "__init__.py" or "kernels" in path.parts or bool(set(listed) - set(defined))
    return bool(lacks) or not passes_on


def test_a_list_of_exports_holds_each_public_definition_and_names_of_others():
    """What a module defines without an underscore is for others; `__all__` is for names that it passes on."""
    assert [name for name, path in zip(MODULES, FILES, strict=True) if wrongly_listed(name, path)] == []


@pytest.mark.parametrize(("package", "others"), [("plantar", {"__version__"}), ("plantar.shoes", set())])
def test_the_names_of_a_lazy_package_are_those_of_its_modules(package, others):
    """The three lists in its __init__.py, for the type checker, the loader and `import *`, say the same."""
    loaded = importlib.import_module(package)
    tree = ast.parse((ROOT.joinpath(*package.split("."), "__init__.py")).read_text(encoding="utf-8"))
    typed = {
        (alias.asname or alias.name, node.module, alias.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module and node.module.partition(".")[0] == "plantar"
        for alias in node.names
    }
    assert {n for n, _, _ in typed} | others == set(loaded.__all__)
    for name, module, called in typed:
        if name in others:
            continue
        assert getattr(loaded, name) is getattr(importlib.import_module(module), called)
        place, _, other = loaded._PLACES.get(name, "errors").partition(":")
        assert (f"{package}.{place}".rstrip("."), other or name) == (module, called)
    assert set(loaded.__all__) <= set(dir(loaded))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        loaded.nothing  # noqa: B018


def test_the_checks_of_this_file_find_what_they_look_for(tmp_path):
    path = tmp_path / "constants.py"
    path.write_text(
        'AA = 1\n"""Why."""\nBB = 2  # why\nCC: int = 3\n\nif AA:\n\n    class E: ...\n\n\ndef f(): ...\n\n\n_G = 4\n'
    )
    assert list(defined_names(path)) == ["AA", "BB", "CC", "E", "f"]
    assert undocumented_constants(path) == ["CC"]


def test_what_a_door_returns_is_shown_in_one_short_line():
    import plantar

    walker = plantar.load_controller("h1")
    reading = plantar.Reading(0.5, [1.0, float("nan")], proximity=[0.1, 0.2])
    box = plantar.shoes.foot_from_dimensions("box", length=0.25, width=0.1)
    shown = [repr(v) for v in (walker, walker.robot, plantar.load_scene("flat"), reading, box)]
    assert all(len(text) < 120 and "\n" not in text for text in shown)
    assert shown[3] == "Reading(0.500 s: 2 taxels, 1.0 N, with proximity)"
    assert shown[4] == "Foot('box': sole 250 x 100 mm)"
