"""Each module says what it exports, and what it exports is there and explained."""

import ast
import importlib
import inspect
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
COMMANDS = {*(ROOT / "plantar" / "commands").glob("*.py")}  # their functions are commands, not for import
FILES = sorted({*(ROOT / "plantar").rglob("*.py")} - COMMANDS)
EXPLAINED = ("FORMAT", "COMMAND", "SOURCE")  # entries of registries, which their type explains
MODULES = [".".join(p.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__") for p in FILES]


def public_functions(module):
    """Functions of a module's own that it exports, and the public methods of the classes that it exports."""
    for name in module.__all__:
        value = getattr(module, name)
        if getattr(value, "__module__", None) != module.__name__:
            continue
        if inspect.isfunction(value):
            yield name, value
        elif inspect.isclass(value):
            for key, member in vars(value).items():
                member = getattr(member, "__func__", member)
                if inspect.isfunction(member) and not key.startswith("_") and member.__module__ == module.__name__:
                    yield f"{name}.{key}", member


def missing_in_docstring(function) -> list[str]:
    """What a function's docstring does not say: each of several arguments, and what comes back."""
    text = inspect.getdoc(function) or ""
    if not text.strip():
        return ["a docstring"]
    missing = []
    arguments = [n for n in inspect.signature(function).parameters if n not in ("self", "cls")]
    if len(arguments) > 1:
        missing += [f"argument '{n}'" for n in arguments if not re.search(rf"\b{n}\b", text)]
        gives = inspect.signature(function).return_annotation not in (None, "None", inspect.Signature.empty)
        if gives and not re.search(r"\b([Rr]eturns|[Yy]ields|[Gg]ives)\b", text):
            missing.append("Returns:")
    return missing


def undocumented_constants(path: Path, exported: list[str]) -> list[str]:
    """Exported names that are assigned without a string after them."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    missing = []
    for node, after in zip(body, [*body[1:], ast.Pass()], strict=True):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        names = [t.id for t in targets if isinstance(t, ast.Name) and t.id in exported]
        names = [n for n in names if not n.startswith("__") and n not in EXPLAINED]
        told = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        missing += [] if told else names
    return missing


@pytest.mark.parametrize("name", MODULES)
def test_a_module_says_what_it_exports_and_explains_it(name):
    module = importlib.import_module(name)
    path = FILES[MODULES.index(name)]
    assert (module.__doc__ or "").strip(), f"{name} has no docstring"
    exported = getattr(module, "__all__", None)
    if path.name == "__init__.py" and exported is None:
        tree = ast.parse(path.read_text(encoding="utf-8"))
        assert not [n for n in tree.body if not isinstance(n, ast.Expr)], f"{name} holds code but no __all__"
        return
    assert exported is not None, f"{name} has no __all__"
    assert len(set(exported)) == len(exported)
    assert [n for n in exported if not hasattr(module, n)] == []
    for n in exported:
        value = getattr(module, n)
        if inspect.isclass(value) or inspect.isfunction(value):
            assert (inspect.getdoc(value) or "").strip(), f"{name}.{n} has no docstring"
    assert undocumented_constants(path, exported) == []
    missing = {key: lack for key, function in public_functions(module) if (lack := missing_in_docstring(function))}
    assert missing == {}


@pytest.mark.parametrize("name", MODULES)
def test_a_public_definition_is_exported(name):
    """What a module defines without an underscore is meant for others, and stands in __all__."""
    path = FILES[MODULES.index(name)]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    defined = {
        n.name for n in tree.body if isinstance(n, ast.FunctionDef | ast.ClassDef) and not n.name.startswith("_")
    }
    assert defined - set(getattr(importlib.import_module(name), "__all__", ())) == set()


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
        assert getattr(loaded, name) is getattr(importlib.import_module(module), called)
        place, _, other = loaded._PLACES.get(name, "errors").partition(":")
        assert (f"{package}.{place}".rstrip("."), other or name) == (module, called)
    assert set(loaded.__all__) <= set(dir(loaded))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        loaded.nothing  # noqa: B018


def test_the_checks_of_this_file_find_what_they_look_for(tmp_path):
    def bare(a, b): ...

    def half(a: int, b: int) -> int:
        """Adds.

        Args:
            a: One number.
        """

    assert missing_in_docstring(bare) == ["a docstring"]
    assert missing_in_docstring(half) == ["argument 'b'", "Returns:"]
    path = tmp_path / "constants.py"
    path.write_text('A = 1\n"""Told."""\nB = 2\nC: int = 3\n')
    assert undocumented_constants(path, ["A", "B", "C"]) == ["B", "C"]
