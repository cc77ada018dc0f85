"""Names of files of all kinds through whole commands: read as under a plain name, or refused in one line."""

import json
import os
import re
from html import unescape
from pathlib import Path
from urllib.parse import unquote

import pytest

from .command_mutants import _biped, _stl, ended
from .taken_away import made
from .targets import TARGETS

NAMES = (
    *(b"a b", b" a", b"a ", b"a\nb", b"a\tb", b"\xff\xfe", b"-a", b"--json", b"it's", b'"q"', b"<b>&amp;", b"#a?b=c&d"),
    *(b"100%", b"%2e%41", b"a:b", b".a", b"$a_{b$", b"$(id)`id`", b"a\\b", b"\x1b[31m", b"{a}%s", b"[bold]a", b"*"),
    *("é😀".encode(), "\u202eab".encode(), "e\u0301".encode(), b"n" * 240, b"nul", b"a,b=c", b"a..b"),
)
DRAWN = (b"\xff\xfe", b"$a_{b$", b"#a?b=c&d", b"<b>&amp;", b"100%", b"a\\b", b"a\tb")
"""Names for commands that take a second or more each."""
_SLOW = ("figures", "compare", "sole", "layout", "body")
_MORE = ("--no-figures", "-o", "{out}")
COMMANDS = {
    "analyze": (".csv", ("analyze", "{file}", *_MORE)),
    "figures": (".csv", ("analyze", "{file}", "-o", "{out}", "--export", "npz")),
    "c3d": (".csv", ("analyze", "{file}", *_MORE, "--export", "c3d", "--export", "csv", "--export", "mot")),
    "compare": (".csv", ("analyze", "--compare", "{file}", "{file}", "-o", "{out}")),
    "view": (".mcap", ("view", "{file}", "-o", "{out}/view.html")),
    "sole": (".mcap", ("sole", "{file}", "-o", "{out}")),
    "live": (".mcap", ("live", "replay:{file}", "--seconds", "0.02", "-o", "{out}/live.mcap")),
    "layout": (".stl", ("shoe", "{file}", "--layout-only", "-o", "{out}")),
    "body": (".xml", ("shoe", "{file}", "--body", "left_foot", "--layout-only", "-o", "{out}")),
}


@pytest.fixture(scope="module")
def contents(tmp_path_factory):
    mcap = TARGETS["mcap"].seeds(tmp_path_factory.mktemp("walk"))[0]
    return {".csv": made(0).text().encode(), ".mcap": mcap, ".stl": _stl(), ".xml": _biped().encode()}


def run(words: tuple[str, ...], file: str, out: str) -> tuple[object, str]:
    """End of a command on a file by a name that may begin with a dash, after which options end."""
    words = tuple(word.replace("{file}", file).replace("{out}", out) for word in words)
    if file.startswith("-") and "--compare" not in words:
        words = (*(word for word in words if word != file), *(("--", file) if file in words else ()))
    code, err, _ = ended(list(words))
    return code, err


def broken_links(page: Path) -> list[str]:
    """Links of a page to files that are not beside it."""
    found = re.findall(r'(?:href|src)="([^"#:]+)"', page.read_text(encoding="utf-8", errors="surrogateescape"))
    files = [unquote(unescape(link), errors="surrogateescape") for link in found]
    return [link for link in files if not (page.parent / link).exists()]


@pytest.mark.parametrize(
    "command", [pytest.param(name, marks=[pytest.mark.long] * (name in _SLOW[:2])) for name in COMMANDS]
)
def test_any_name_is_read_as_a_plain_one(command, contents, tmp_path, monkeypatch, quick_figures):
    """From the folder of the files, so that the name is all of the path, into a folder of the same name."""
    monkeypatch.chdir(tmp_path)
    suffix, words = COMMANDS[command]
    failed = []
    for name in DRAWN if command in _SLOW else NAMES:
        file = os.fsdecode(name) + suffix
        out = os.fsdecode(b"out" + name)
        Path(file).write_bytes(contents[suffix])
        code, err = run(words, file, out)
        lost = [str(p) for p in Path(out).glob("*.html") if broken_links(p)]
        if name == b"\xff\xfe" and command in ("c3d", "body"):  # whose libraries open no such file
            assert (code, err.count("\n"), "UTF-8" in err) == (2, 1, True), err
        elif code != 0 or lost or "Warning" in err or "\x1b[31m" in err:
            failed.append((name, code, err[:300], lost))
    assert failed == []


@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_file_is_refused_in_one_line(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    suffix, words = COMMANDS[command]
    names = [f"{kind}{suffix}" for kind in ("folder", "pipe", "loop", "none", "empty")]
    folder, pipe, loop, _, empty = names
    Path(folder).mkdir()
    os.mkfifo(pipe)
    Path(loop).symlink_to(loop)
    Path(empty).touch()
    for name in (*names, "", "/dev/null", "/dev/zero", "n" * 300 + suffix, "a\0b" + suffix, f"none/a{suffix}"):
        if "\0" in name and command != "analyze":
            continue
        code, err = run(words, name, "out")
        assert (code, err.count("\n"), err[:9]) == (2, 1, "plantar: "), (name, code, err)
    assert not Path("out").exists()


def test_a_study_of_files_of_any_names(contents, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = Path("a #%<b>?")
    folder.mkdir()
    for name in NAMES:
        (folder / os.fsdecode(name + b".csv")).write_bytes(contents[".csv"])
    code, err = run(("analyze", "{file}", *_MORE), str(folder), "out")
    assert code == 0, err
    shown = [name for name in NAMES if not name.startswith(b".")]
    assert json.loads(Path("out/study.json").read_text())["measured"] == len(shown)
    assert [p for page in Path("out").rglob("*.html") for p in broken_links(page)] == []
