"""What setup.py tells an index: README's links and the addresses of the project."""

import re
import runpy
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture
def told(monkeypatch):
    """What setup.py hands to setuptools, without compiling, where PLANTAR_HOME has a value or none."""

    def of(home: str | None) -> dict[str, object]:
        given: dict[str, object] = {}
        monkeypatch.chdir(ROOT)
        monkeypatch.setitem(sys.modules, "Cython.Build", None)
        monkeypatch.setattr("setuptools.setup", given.update)
        if home is None:
            monkeypatch.delenv("PLANTAR_HOME", raising=False)
        else:
            monkeypatch.setenv("PLANTAR_HOME", home)
        runpy.run_path("setup.py")
        return given

    return of


def test_a_build_with_a_home_has_links_that_work_away_from_the_repository(told):
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dynamic"]
    assert {"readme", "urls"} <= set(version)
    given = told("https://example.org/a/plantar/")
    text = str(given["long_description"])
    targets = [*re.findall(r"\]\(([^)]+)\)", text), *re.findall(r'(?:src|srcset)="([^"]+)"', text)]
    assert len(targets) > 40
    assert [t for t in targets if not t.startswith(("#", "https://"))] == []
    named = {t for t in targets if t.startswith("https://example.org/a/plantar/")}
    for target in named:
        kind, _, path = target.removeprefix("https://example.org/a/plantar/").split("/", 2)
        assert kind == ("raw" if f'"{target}"' in text else "blob")
        assert (ROOT / path.partition("#")[0]).exists(), target
    assert given["project_urls"]["Source"] == "https://example.org/a/plantar"


def test_a_build_without_a_home_invents_no_address(told):
    given = told(None)
    assert given["long_description"] == (ROOT / "README.md").read_text(encoding="utf-8")
    assert given["project_urls"] == {}


def test_no_page_asks_the_index_for_a_name_that_is_free():
    pages = [
        ROOT / "README.md",
        *(p for folder in ("docs", "examples", "benchmarks") for p in (ROOT / folder).rglob("*")),
    ]
    asked = [
        p.name
        for p in pages
        if p.suffix in {".md", ".py", ".ipynb"}
        and re.search(r"pip install \W?plantar\b", p.read_text(encoding="utf-8"))
    ]
    assert asked == []
