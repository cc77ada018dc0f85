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


@pytest.mark.parametrize("name", MODULES)
def test_what_a_module_offers_is_explained(name):
    module = importlib.import_module(name)
    path = FILES[MODULES.index(name)]
    assert (module.__doc__ or "").strip(), f"{name} has no docstring"
    if path.name == "__init__.py" and not hasattr(module, "__all__"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert not [n for n in tree.body if not isinstance(n, ast.Expr)], f"{name} holds code but no __all__"
        return
    exported = public_names(module)
    assert len(set(exported)) == len(exported)
    assert [n for n in exported if not hasattr(module, n)] == []
    for n in exported:
        value = getattr(module, n)
        if inspect.isclass(value) or inspect.isfunction(value):
            assert (inspect.getdoc(value) or "").strip(), f"{name}.{n} has no docstring"
    assert undocumented_constants(path) == []


@pytest.mark.parametrize("name", MODULES)
def test_a_list_of_exports_holds_each_public_definition_and_names_of_others(name):
    """What a module defines without an underscore is for others; `__all__` is for names that it passes on."""
    path = FILES[MODULES.index(name)]
    listed = getattr(importlib.import_module(name), "__all__", None)
    if listed is not None:
        defined = defined_names(path)
        assert {n for n, node in defined.items() if not isinstance(node, ast.Assign)} <= set(listed)
        assert path.name == "__init__.py" or "kernels" in path.parts or set(listed) - set(defined)


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
