"""Any file that somebody else made: a command takes it, or refuses it in one line, at once, and leaves nothing.

A file is not to take more than 5 s of the processor and 500 MB. It is the processor's time that is measured, of the
command and of what it starts, since the wall clock tells how busy the machine is; a command that waits for ever is
ended after ten minutes. The memory is that of the largest process. Beside busy processes, with which it shares caches
and cores, a command takes up to half more of the processor than alone: twice the 5 s are allowed here.
"""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from .hostile_files import COMMANDS, DEFECTS_OF_ANY, FAMILIES, Content

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="pipes, devices and memory as on Linux")

MOST_SECONDS = 10.0
MOST_MEGABYTES = 500.0

# One process loads the command line, and forks for each command: what that takes is the child's, and its children's.
_FORKS = """
import json, os, signal, sys
from plantar import __main__, cli
for line in sys.stdin:
    folder, *arguments = json.loads(line)
    if not (child := os.fork()):
        os.chdir(folder)
        for number, name in ((0, os.devnull), (1, "logs/stdout"), (2, "logs/stderr")):
            os.dup2(os.open(name, os.O_RDWR | os.O_CREAT), number)
        sys.argv = ["plantar", *arguments]
        signal.alarm(600)
        __main__.main()
    _, status, used = os.wait4(child, 0)
    code, seconds = os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime
    print(json.dumps([code, seconds, used.ru_maxrss / 1e3]), flush=True)
"""


@pytest.fixture(scope="module")
def forks():
    """The process that runs commands."""
    command = [sys.executable, "-c", _FORKS]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield process


@dataclass
class Ended:
    """How a command ended."""

    code: int
    seconds: float
    megabytes: float
    out: str
    err: str


def measured(forks: Any, folder: Path, *arguments: str) -> Ended:
    """Run the command line in a folder."""
    logs = folder / "logs"
    logs.mkdir()
    forks.stdin.write(json.dumps([str(folder), *arguments]) + "\n")
    forks.stdin.flush()
    code, seconds, megabytes = json.loads(forks.stdout.readline())
    texts = [(logs / name).read_text(errors="replace") for name in ("stdout", "stderr")]
    return Ended(code, seconds, megabytes, *texts)


def write(path: Path, content: Content) -> None:
    """Make a file of the family."""
    if callable(content):
        content(path)
    elif isinstance(content, str):
        path.write_text(content)
    else:
        path.write_bytes(content)


def refused(forks: Any, folder: Path, kind: str, content: Content) -> None:
    """A file of a kind is refused by the command that reads it, in one line and in time, and nothing is left."""
    path = folder / f"foot.{kind}"
    good = folder / "good.csv"
    good.write_text("time,left 1,left 2,left 3\n" + "".join(f"{0.01 * i},1,2,3\n" for i in range(50)))
    write(path, content)
    before = {p.name for p in folder.iterdir()}
    places = {"file": path, "out": folder / "out", "good": good, "folder": folder}
    arguments = [a.format(**places) for a in COMMANDS[kind]]
    ended = measured(forks, folder, *arguments)
    left = {p.name for p in folder.iterdir()} - before
    if path.is_file() and not path.is_symlink():
        path.unlink()  # some are large
    said = ended.err[:300]
    assert ended.code == 2, (ended, said)
    assert ended.out == ""
    assert ended.err.count("\n") == 1, said
    assert ended.err.startswith("plantar: "), said
    assert len(ended.err) < 1000
    assert ended.seconds < MOST_SECONDS, (ended.seconds, said)
    assert ended.megabytes < MOST_MEGABYTES, (ended.megabytes, said)
    assert left == {"logs"}


ANY = {f"{kind}: {defect}": (kind, content) for kind in COMMANDS for defect, content in DEFECTS_OF_ANY.items()}


@pytest.mark.sample(12)
@pytest.mark.parametrize("name", FAMILIES)
def test_a_hostile_file_is_refused_in_one_line_at_once(name, forks, tmp_path):
    refused(forks, tmp_path, *FAMILIES[name])


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ANY)
def test_what_may_stand_behind_any_name_is_refused(name, forks, tmp_path):
    refused(forks, tmp_path, *ANY[name])
