"""Gather the pages of the site in out/pages: those of docs/ and examples/, and generated ones.

    python tools/docs_pages.py

Generated are the settings with units and ranges, the errors, and a page of the API for each room of a package. Links to
files that are no pages of the site become their names, and names of the library's rooms links to their API.
"""

import ast
import html
import os
import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = ROOT / "out" / "pages"
PACKAGES = ("plantar", "plantar.shoes", "plantar.gait", "plantar.robots", "plantar.wholebody", "plantar.sim")
DOORS = ("read", "analyse", "view", "load_robot", "load_controller", "load_scene", "run")
"""The functions of the root that the API begins with."""

HIDDEN = {"plantar.bench", "plantar.kernels", "plantar.cli", "plantar.commands", *PACKAGES[1:]}
"""Rooms without a page: measurements, what is called through `plantar.geometry` and `plantar.percepts`, the command
line, and packages, which have a list of their own."""

NOT_SEARCHED = ("settings.md", "architecture.md", "scale.md", "changelog.md", "api/plantar.", "benchmarks/")
"""Pages that the search leaves out, by how their place begins: what the project looks like inside."""

_LEFT_OUT = "---\nsearch:\n  exclude: true\n---\n"  # what the theme's search understands

CODE = re.compile(r"(?<!\[)`((?:plantar|gait|robots|sim|shoes|wholebody)(?:/\w+)+)(?:\.py)?`(?!\])")
"""A folder or file of the library as it is written on a page, outside of links."""

LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#\s]+)((?:#[^)]*)?)\)")


def main() -> None:
    """Write all pages."""
    shutil.rmtree(PAGES, ignore_errors=True)
    shutil.copytree(ROOT / "docs", PAGES)
    for folder in ("examples", "benchmarks"):
        (PAGES / folder).mkdir()
        for page in (ROOT / folder).glob("*.md"):
            shutil.copy(page, PAGES / folder / page.name)
    shutil.copy(ROOT / "CHANGELOG.md", PAGES / "changelog.md")
    for example in sorted((ROOT / "examples").glob("*.py")):
        code = example.read_text(encoding="utf-8")
        (PAGES / "examples" / f"{example.stem}.md").write_text(f"# {example.stem}\n\n```python\n{code}```\n")
    (PAGES / "settings.md").write_text(settings_page(), encoding="utf-8")
    (PAGES / "errors.md").write_text(errors_page(), encoding="utf-8")
    write_api()
    for page in PAGES.rglob("*.md"):
        inside = page.relative_to(PAGES).as_posix().startswith(NOT_SEARCHED)
        page.write_text((_LEFT_OUT if inside else "") + linked(page), encoding="utf-8")


def linked(page: Path) -> str:
    """A page's text, its links leading to pages of the site."""

    def target(match: re.Match[str]) -> str:
        picture, text, path, anchor = match.groups()
        if "://" in path or path.startswith("mailto:"):
            return match[0]
        place = Path(os.path.normpath(page.parent / path))
        known = place if place.exists() else PAGES / Path(os.path.normpath(_origin(page).parent / path)).name
        inside = _of_the_site(page, path)
        if inside is not None:
            return f"{picture}[{text}]({inside}{anchor})"
        return match[0] if known.exists() and known.is_relative_to(PAGES) else f"{picture}{text}"

    def api(match: re.Match[str]) -> str:
        path = match[1] if match[1].startswith("plantar/") else f"plantar/{match[1]}"
        rooms = (path.replace("/", "."), os.path.dirname(path).replace("/", "."))
        known = [place for room in rooms if (place := PAGES / "api" / f"{room}.md").is_file()]
        return f"[{match[0]}]({os.path.relpath(known[0], page.parent)})" if known else match[0]

    parts = re.split(r"(^```.*?^```$)", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    return "".join(part if part.startswith("```") else CODE.sub(api, LINK.sub(target, part)) for part in parts)


def _origin(page: Path) -> Path:
    """The file of the repository that a page was made of."""
    relative = page.relative_to(PAGES)
    if relative.parts[0] in ("examples", "benchmarks"):
        return ROOT / relative
    return ROOT / "CHANGELOG.md" if relative.name == "changelog.md" else ROOT / "docs" / relative


def _of_the_site(page: Path, path: str) -> str | None:
    """Where a link to a file of the repository leads on the site, from a page; None where the site lacks it."""
    file = Path(os.path.normpath(_origin(page).parent / path))
    if not file.is_relative_to(ROOT):
        return None
    inside = file.relative_to(ROOT)
    if inside.parts[:1] == ("docs",):
        place = PAGES.joinpath(*inside.parts[1:])
    elif inside.parts[:1] == ("examples",) and inside.suffix == ".py":
        place = PAGES / inside.with_suffix(".md")
    elif inside.name == "CHANGELOG.md":
        place = PAGES / "changelog.md"
    else:
        place = PAGES / inside
    return os.path.relpath(place, page.parent) if place.is_file() else None


def settings_page() -> str:
    """Every setting with default, unit and range."""
    from plantar.common.settings.overrides import setting_rows
    from plantar.sim.run.setting_list import settings_of_robot

    rows = setting_rows(settings_of_robot(None, None))
    tables: dict[str, list[str]] = {}
    for row in rows:
        table, _, name = row["name"].rpartition(".")
        default = f"`{row['default']}` {row['unit']}".strip() + (f" = {row['share']}" if row["share"] else "")
        cells = (f"`{name}`", default, row["allowed"], row["meaning"])
        tables.setdefault(table or "scene", []).append("| " + " | ".join(_cell(c) for c in cells) + " |")
    text = [
        "# Settings",
        "",
        f"All {len(rows)} keys of a scene, as `plantar list settings` lists them, with the numbers of H1. A default "
        "that grows with the robot is shown with its share. `--set TABLE.NAME=VALUE` changes one for a run, `--grid` "
        "sweeps it; in a scene file each heading is a table.",
    ]
    for table, lines in tables.items():
        text += ["", f"## {table}", "", "| name | default | allowed | meaning |", "|---|---|---|---|", *lines]
    return "\n".join(text) + "\n"


def _cell(text: str) -> str:
    """A text that does not end its cell of a table."""
    return html.escape(text, quote=False).replace("|", "\\|").replace("\n", " ")


WHAT_TO_DO = {
    "PlantarError": "Catch this one to catch all.",
    "InputError": "The message names the argument and what is allowed; `plantar COMMAND --help` shows examples.",
    "LayoutError": "The message names the field of the layout file. Positions in m, cells as corners in order.",
    "ReadingError": "Give one value a taxel, in the order of the layout; NaN for a taxel that gave none.",
    "RecordingError": "Check folder, space and rights; a recording that was cut off is read up to there.",
    "FormatError": "`--format` names it; `--unit`, `--rate`, `--side`, `--layout` give what the file does not.",
    "FootError": "`--unit`, `--up`, `--forward` and `--sole-z` give what the geometry leaves open.",
    "RobotError": "`plantar robot check ROBOT.toml` measures what would go wrong, and which value works.",
    "SceneError": "The nearest key is named; `plantar list settings` lists all with their ranges.",
    "WorkerError": "What was run is kept: give the same command again when the workers are back.",
    "KernelError": "Install a C compiler and run the command of the message; `plantar doctor` shows what is compiled.",
    "DependencyError": "The message holds the `pip install` line; `plantar doctor` shows all at once.",
}
"""What a user does about each error."""


def errors_page() -> str:
    """Every error, what it means and what to do."""
    tree = ast.parse((ROOT / "plantar" / "errors.py").read_text(encoding="utf-8"))
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    text = [
        "# Errors and what to do",
        "",
        "Every error that Plantar raises on purpose is one line: what is wrong, and what is allowed. The command line "
        "prints it and ends with exit code 2, and leaves nothing behind. Anything else is a bug: please report it.",
        "",
        "| error | means | what to do |",
        "|---|---|---|",
    ]
    for node in classes:
        meaning = (ast.get_docstring(node) or "").splitlines()[0]
        text.append(f"| `{node.name}` | {meaning} | {WHAT_TO_DO[node.name]} |")
    return "\n".join(text) + "\n"


def write_api() -> None:
    """A page for each room of each package, one for each folder inside of it, and their list."""
    (PAGES / "api").mkdir()
    index = ["# API", "", "::: plantar", "    options:", "      members: false", "      show_root_heading: false", ""]
    index += ["## Doors", ""]
    tree = ast.parse((ROOT / "plantar" / "__init__.py").read_text(encoding="utf-8"))
    found = [
        node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module not in (None, "plantar")
    ]
    doors = {alias.asname or alias.name: f"{n.module}.{alias.name}" for n in found for alias in n.names}
    for door in DOORS:
        index += [f"### plantar.{door}", "", f"::: {doors[door]}", "    options:", "      show_root_heading: false", ""]
    index += ["## Packages", "", "A package is laid out by question, one folder (a room) or one file each.", ""]
    for package in PACKAGES:
        index += [f"## {package}", "", "| room | what it is |", "|---|---|"]
        for room, path in _rooms(ROOT.joinpath(*package.split(".")), package):
            modules = _modules(path, room)
            if not modules:
                continue
            first = _summary(path / "__init__.py" if path.is_dir() else path)
            index.append(f"| [{room}]({room}.md) | {_cell(first)} |")
            (PAGES / "api" / f"{room}.md").write_text(_api_page(room, modules), encoding="utf-8")
        index.append("")
    (PAGES / "api" / "index.md").write_text("\n".join(index), encoding="utf-8")


def _rooms(folder: Path, name: str) -> Iterator[tuple[str, Path]]:
    """Rooms of a package with their folders or files, each before the folders inside of it."""
    for path in sorted(folder.iterdir()):
        room = f"{name}.{path.stem}"
        if room in HIDDEN or path.name.startswith("_"):
            continue
        if path.is_dir():
            yield room, path
            yield from ((inner, place) for inner, place in _rooms(path, room) if place.is_dir())
        elif path.suffix == ".py":
            yield room, path


def _modules(path: Path, room: str) -> list[str]:
    """Modules of a room that have public names of their own, without those of folders inside of it."""
    if path.suffix == ".py":
        return [room]
    return [f"{room}.{file.stem}" for file in sorted(path.glob("*.py")) if not file.stem.startswith("_")]


def _summary(file: Path) -> str:
    """First line of a module's docstring."""
    text = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) if file.exists() else None
    return (text or "").split("\n")[0]


def _api_page(room: str, modules: list[str]) -> str:
    """The page of a room: its modules one after the other, by their docstrings."""
    parts = [f"# {room}", ""]
    for module in modules:
        parts += [f"## {module}", "", f"::: {module}", "    options:", "      heading_level: 3", ""]
    return "\n".join(parts)


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    main()
