"""Names that a module offers."""

import ast
from pathlib import Path
from types import ModuleType


def public_names(module: ModuleType) -> list[str]:
    """`__all__` of a package or of a module that passes on others' names, else what the module defines in its source.

    Functions, classes and constants without an underscore; types of one letter and aliases of types are for its own
    annotations.
    """
    stated = getattr(module, "__all__", None)
    return list(defined_names(Path(str(module.__file__)))) if stated is None else list(stated)


def defined_names(path: Path) -> dict[str, ast.stmt]:
    """Functions, classes and constants without an underscore that a file defines, in its order."""
    found: dict[str, ast.stmt] = {}
    body = ast.parse(path.read_text(encoding="utf-8")).body
    for node in [inner for n in body for inner in ((*n.body, *n.orelse) if isinstance(n, ast.If) else (n,))]:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[node.name] = node
        else:
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            names = [x.id for t in targets if t is not None for x in ast.walk(t) if isinstance(x, ast.Name)]
            found |= {name: node for name in names if name.isupper() and len(name) > 1}
    return {name: node for name, node in found.items() if not name.startswith("_")}
