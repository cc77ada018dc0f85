"""The pages of the site: what they show runs from nothing to its end, and all of them can be gathered."""

import importlib.util
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from .public_names import public_names

ROOT = Path(__file__).resolve().parent.parent
PAGES = [
    *(ROOT / "docs" / f"{name}.md" for name in ("start", "questions", "concepts")),
    *sorted((ROOT / "docs" / "tutorials").glob("*.md")),
    *(p for p in sorted((ROOT / "docs" / "answers").glob("*.md")) if p.stem != "index"),
]
QUICK = {"concepts", "format", "loop", "part", "questions", "sensor", "task"} | {"belts", "foot_force", "pads"}
"""Pages that take a few seconds at most; the others walk, build or analyse, and run with the long tests."""
BLOCK = re.compile(r"^```(python|sh)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def follow(page: Path, folder: Path) -> None:
    """Do what a page says, in a folder, in its order. Two machines are this one, with one worker and one seed."""
    scripts = Path(sys.executable).parent
    env = os.environ | {"PATH": f"{scripts}{os.pathsep}{os.environ.get('PATH', '')}"}
    names: dict[str, object] = {"__name__": "page"}
    port = str(free_port())
    content = page.read_text(encoding="utf-8").replace("192.0.2.1:8786", f"127.0.0.1:{port}")
    content = content.replace("--nworkers 8", "--nworkers 1").replace("--seeds 20", "--seeds 1")
    with ExitStack() as servers:
        for language, text in BLOCK.findall(content):
            if language == "python":
                exec(compile(text, str(page), "exec"), names)
                continue
            for line in text.splitlines():
                words = shlex.split(line, comments=True)
                if words[:1] == ["openssl"]:
                    subprocess.run(words, cwd=folder, env=env, check=True, capture_output=True)
                elif words[:1] == ["export"]:
                    env |= dict(word.split("=", 1) for word in words[1:])
                elif words[:1] == ["dask"]:
                    at = ["--host", "127.0.0.1", "--port", port] if words[1] == "scheduler" else []
                    log = servers.enter_context((folder / f"{words[1]}.log").open("w"))
                    server = subprocess.Popen(
                        [*words, *at, "--no-dashboard"], cwd=folder, env=env, stdout=log, stderr=log
                    )
                    servers.callback(server.wait)
                    servers.callback(server.terminate)
                elif words[:1] == ["plantar"]:
                    done = subprocess.run(words, cwd=folder, env=env, capture_output=True, text=True)
                    expected = 1 if "# exit code 1" in line else 0
                    assert done.returncode == expected, f"{line}: exit {done.returncode}\n{done.stdout}\n{done.stderr}"


def free_port() -> int:
    """A port of this machine that nobody listens on."""
    with socket.socket() as asked:
        asked.bind(("127.0.0.1", 0))
        return int(asked.getsockname()[1])


@pytest.mark.parametrize(
    "page", [pytest.param(p, id=p.stem, marks=[] if p.stem in QUICK else [pytest.mark.long]) for p in PAGES]
)
@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_a_newcomer_comes_to_the_end_of_a_page(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    follow(page, tmp_path)


@pytest.fixture(scope="module")
def docs_pages():
    """The script that gathers the pages."""
    spec = importlib.util.spec_from_file_location("docs_pages", ROOT / "tools" / "docs_pages.py")
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_site_has_every_page_and_names_no_other(docs_pages, tmp_path, monkeypatch):
    yaml = pytest.importorskip("yaml")
    monkeypatch.setattr(docs_pages, "PAGES", tmp_path / "pages")
    docs_pages.main()
    nav = yaml.safe_load((ROOT / "mkdocs.yml").read_text())["nav"]
    named = set(re.findall(r"[\w./-]+\.md", str(nav)))
    made = {p.relative_to(tmp_path / "pages").as_posix() for p in (tmp_path / "pages").rglob("*.md")}
    assert named <= made
    assert {m for m in made - named if not m.startswith(("api/", "benchmarks/", "examples/"))} == set()
    settings = (tmp_path / "pages" / "settings.md").read_text(encoding="utf-8")
    assert settings.count("\n| `") > 500
    assert "70.02 N = 0.083 weight" in settings.replace("`", "")
    found = {m for m in made if not (tmp_path / "pages" / m).read_text(encoding="utf-8").startswith("---\nsearch:")}
    assert {"limits.md", "metrics.md", "recordings.md", "api/index.md", "answers/pads.md"} <= found
    assert not found & {"settings.md", "benchmarks/README.md", "api/plantar.formats.md", "changelog.md"}
    part = (tmp_path / "pages" / "tutorials" / "part.md").read_text(encoding="utf-8")
    assert "[`plantar/sim/terrain`](../api/plantar.sim.terrain.md)" in part
    for page in (tmp_path / "pages").rglob("*.md"):
        text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        links = [t for t in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text) if "://" not in t]
        assert [t for t in links if not (page.parent / t).exists()] == [], page


@pytest.mark.skipif(not any(map(shutil.which, ("chromium", "chromium-browser"))), reason="needs Chromium")
def test_the_check_of_the_pages_opens_them_and_names_a_dead_link(tmp_path):
    site = tmp_path / "site"
    site.mkdir()
    check = [sys.executable, str(ROOT / "tools" / "check_site.py"), str(site), "--axe", str(tmp_path / "none")]
    (site / "index.html").write_text('<!doctype html><title>a</title><a href="gone/">b</a>')
    done = subprocess.run(check, capture_output=True, text=True, timeout=300)
    assert done.returncode == 1, done.stderr
    assert "/index.html: leads to gone/, which is not there" in done.stdout
    (site / "index.html").write_text("<!doctype html><title>a</title>")
    done = subprocess.run(check, capture_output=True, text=True, timeout=300)
    assert (done.returncode, done.stdout.rpartition("\x1b[K")[2]) == (0, "nothing found on 1 pages, 1 of them opened\n")


def test_every_error_is_explained(docs_pages):
    from plantar import errors

    assert set(docs_pages.WHAT_TO_DO) == set(public_names(errors))
