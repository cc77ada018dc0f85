"""Write docs/licences.md: the licences of the libraries that Plantar depends on, as their packages state them.

python tools/licences.py          # writes the page; a library that is not installed here keeps its row
python tools/licences.py --check  # exit code 1 where a declared dependency is not on the page
"""

import re
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "licences.md"
HEAD = """# Licences of what Plantar depends on

Made by `python tools/licences.py` from what the installed packages state of themselves. Plantar is Apache-2.0 and
contains none of them, but three.js 0.170 (MIT, `plantar/viewer/three.LICENSE.txt`), with which pages of `plantar view`
draw, and the descriptors of three Foxglove schemas (MIT). Extras: none = always installed; `dev` and `docs` only for
working on Plantar itself, where the one library under the GPL belongs: quadprog, a reference in tests.

| library | extra | licence |
|---|---|---|
"""


def declared() -> dict[str, list[str]]:
    """Names of the libraries in pyproject.toml, and the extras that bring each."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found: dict[str, list[str]] = {}
    for extra, lines in {"": project["dependencies"], **project["optional-dependencies"]}.items():
        for name in (re.split(r"[\[<>=~! ]", line)[0] for line in lines):
            if name != "plantar":
                found.setdefault(name, []).append(extra)
    return found


def stated() -> dict[str, str]:
    """Licences that the page states by library, as somebody had them installed."""
    text = PAGE.read_text(encoding="utf-8") if PAGE.is_file() else ""
    return dict(re.findall(r"^\| ([\w.-]+) \|[^|]*\| (.*?) \|$", text, re.MULTILINE))


def licence(name: str) -> str:
    """Licence of an installed package: its SPDX expression, its classifiers, or the first line of its text."""
    try:
        facts = metadata(name)
    except PackageNotFoundError:
        return stated().get(name, "not installed here")
    kinds = [c.rpartition(" :: ")[2] for c in facts.get_all("Classifier") or [] if c.startswith("License")]
    own = (facts.get("License") or "").strip().split("\n")[0]
    return str(facts.get("License-Expression") or ", ".join(kinds) or own or "see its package")


def page() -> str:
    """The page's text."""
    rows = [f"| {n} | {', '.join(e for e in extras if e)} | {licence(n)} |" for n, extras in sorted(declared().items())]
    return HEAD + "\n".join(rows) + "\n"


def main() -> None:
    """Write the page, or check it."""
    if sys.argv[1:] == ["--check"]:
        wrong = (stated().keys() - {"library"}) ^ declared().keys()
        sys.exit(f"docs/licences.md lacks or has too much: {', '.join(sorted(wrong))}" if wrong else 0)
    if sys.argv[1:]:
        sys.exit(f"{' '.join(sys.argv[1:])}: unknown; allowed: nothing, which writes the page, or --check")
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
