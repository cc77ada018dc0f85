"""Each name that users import says what it takes, gives and raises; every other name says what it does in a line."""

import ast
import importlib
import inspect
import json
import re
import textwrap
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LISTED = (Path(__file__).parent / "documented_names.txt").read_text(encoding="utf-8").split()
"""The names for users, as they import them."""

FILES = sorted((ROOT / "plantar").rglob("*.py"))
IMPORT = re.compile(r"^\s*(?:>>> )?from (plantar[\w.]*) import (\([^)]*\)|[^\n#(`]*)", re.MULTILINE)


def value_of(name):
    """What a dotted name stands for."""
    module, _, last = name.rpartition(".")
    try:
        owner = importlib.import_module(module)
    except ModuleNotFoundError:
        owner = value_of(module)
    return getattr(owner, last) if hasattr(owner, last) else importlib.import_module(name)


def code_of(page):
    """Text of a page, or the code of a notebook."""
    text = page.read_text(encoding="utf-8")
    if page.suffix != ".ipynb":
        return text
    return "\n".join("".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == "code")


def shown_names():
    """Names that the readme, pages and examples import."""
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    pages += [page for kind in ("*.md", "*.py", "*.ipynb") for page in (ROOT / "examples").rglob(kind)]
    found = set()
    for page in pages:
        for module, names in IMPORT.findall(code_of(page)):
            found |= {f"{module}.{name}" for name in re.findall(r"\w+", re.sub(r" as \w+", "", names))}
    return sorted(found)


def is_ours(value):
    return (inspect.isclass(value) or inspect.isfunction(value)) and value.__module__.startswith("plantar")


def missing_in(function):
    """What a function's docstring lacks: a summary, arguments, what it returns, what it raises itself."""
    text = inspect.getdoc(function) or ""
    if not text.strip():
        return ["a summary"]
    signature = inspect.signature(function)
    arguments = [name for name in signature.parameters if name not in ("self", "cls")]
    several = len(arguments) > 1  # of one argument the summary says what it is, and what comes of it
    missing = [f"argument '{name}'" for name in arguments if several and not re.search(rf"\b{name}\b", text)]
    gives = signature.return_annotation not in (None, "None", inspect.Signature.empty)
    if gives and several and not re.search(r"\b(?:[Rr]eturns?|[Yy]ields?|[Gg]ives?)\b", text):
        missing.append("Returns")
    raised = list(ast.walk(ast.parse(textwrap.dedent(inspect.getsource(function)))))
    causes = [ast.unparse(node.exc) for node in raised if isinstance(node, ast.Raise) and node.exc]
    if any(not cause.startswith("NotImplementedError") for cause in causes) and not re.search(
        r"\b[Rr]aises?\b|Error\b", text
    ):
        missing.append("Raises")
    return missing


def functions_of(value):
    """A listed function, or the public methods that a listed class defines."""
    if inspect.isfunction(value):
        return {value.__name__: value}
    found = {key: getattr(member, "__func__", member) for key, member in vars(value).items() if not key.startswith("_")}
    return {key: member for key, member in found.items() if inspect.isfunction(member)}


def without_summary(path):
    """Functions and classes of a file, without underscores, that no sentence describes."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = [n for n in tree.body if isinstance(n, ast.FunctionDef | ast.ClassDef) and not n.name.startswith("_")]
    return [n.name for n in nodes if not (ast.get_docstring(n) or "").strip()]


@pytest.mark.parametrize("name", LISTED)
def test_a_listed_name_says_what_it_takes_gives_and_raises(name):
    value = value_of(name)
    assert (inspect.getdoc(value) or "").strip()
    missing = {key: lack for key, function in functions_of(value).items() if (lack := missing_in(function))}
    assert missing == {}


def test_every_name_that_a_page_or_example_imports_is_listed():
    listed = {id(value_of(name)) for name in LISTED}
    assert [n for n in shown_names() if is_ours(value := value_of(n)) and id(value) not in listed] == []


def test_every_name_of_the_root_is_listed():
    root = importlib.import_module("plantar")
    listed = {id(value_of(name)) for name in LISTED}
    assert [n for n in root.__all__ if is_ours(value := getattr(root, n)) and id(value) not in listed] == []


def test_every_public_definition_has_a_summary():
    assert {str(path.relative_to(ROOT)): names for path in FILES if (names := without_summary(path))} == {}


def test_a_lack_is_found():
    def half(a: int, b: int) -> int:
        """Adds `a` to another."""
        raise ValueError(a)

    assert missing_in(half) == ["argument 'b'", "Returns", "Raises"]
