"""With one kernel of the build missing every command still works or refuses, and each names that kernel in one line."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from subprocess import PIPE

import pytest

from plantar import kernels
from plantar.common.optional_library import LIBRARIES
from plantar.kernels.build_stamp import STAMP

PACKAGE = Path(kernels.__file__).resolve().parents[1]
EACH_COMMAND = Path(__file__).with_name("each_command.py")
DEMO = PACKAGE / "commands" / "small_demo"
EXTENSIONS = (PACKAGE / "kernels" / STAMP).read_text().split()[1:] if kernels.compiled else []

WORKS = [
    ["doctor"],
    ["live", f"replay:{DEMO / 'robot.mcap'}", "--seconds", "0.2", "-o", "live.mcap"],
    ["list", "robots"],
    ["sole", str(DEMO / "robot.mcap"), "-o", "sole"],
    ["view", str(DEMO / "robot.mcap"), "-o", "view.html"],
]
"""Commands that work interpreted."""

WORKS_SLOWLY = [
    ["analyze", str(DEMO / "insole.asc"), "-o", "analysis"],
    ["bench", "kernels", "--quick", "-o", "kernels"],
    ["demo", "--small", "-o", "demo"],
    ["robot", "check", "h1"],
    ["shoe", "--robot", "h1", "--side", "left", "-o", "shoe"],
]
"""Those that take some ten seconds each."""

FIRST_OF_ROOM = list({name.partition(".")[0]: name for name in reversed(EXTENSIONS)}.values())
"""One extension of each room: which one is missing does not matter to a command that loads none at all."""

REFUSED = [
    ["sim", "flat"],
    ["robot", "none.xml"],
    ["sweep", "flat", "--seeds", "1"],
    ["demo"],
    *(["bench", kind] for kind in ("scenes", "skip", "stress", "footholds")),
]
"""Commands that walk, which takes the compiled form."""

pytestmark = [
    pytest.mark.skipif(not EXTENSIONS or not hasattr(os, "fork"), reason="none are compiled here, or nothing forks"),
    pytest.mark.skipif(find_spec("mujoco") is None, reason="needs mujoco"),
]


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the package."""
    folder = tmp_path_factory.mktemp("copy")
    shutil.copytree(PACKAGE, folder / "plantar", ignore=shutil.ignore_patterns("__pycache__"))
    return folder


@pytest.fixture
def without(copy, request):
    """The line about an extension that the copy lacks while the test lasts."""
    name = request.param
    room, _, kernel = name.partition(".")
    (extension,) = (copy / "plantar" / "kernels" / room).glob(f"{kernel}.*.so")
    away = extension.with_suffix(".away")
    extension.rename(away)
    yield f"kernels: plain Python, slower (1 of {len(EXTENSIONS)} compiled ones are missing: {name}); install a"
    away.rename(extension)
    for made in copy.iterdir():
        if made.name != "plantar":
            shutil.rmtree(made) if made.is_dir() else made.unlink()


@contextmanager
def started(copy: Path, *libraries: str) -> Iterator[Callable[[list[str]], dict[str, object]]]:
    """Runs `plantar WORDS` of the copy, the libraries loaded already."""
    environment = {**os.environ, "PLANTAR_KERNELS": "", "PYTHONPATH": ""}
    words = [sys.executable, "-P", str(EACH_COMMAND), *libraries]
    with subprocess.Popen(words, env=environment, cwd=copy, stdin=PIPE, stdout=PIPE, text=True) as process:

        def run(words: list[str]) -> dict[str, object]:
            process.stdin.write(json.dumps(words) + "\n")
            process.stdin.flush()
            return json.loads(process.stdout.readline())

        yield run
        process.stdin.close()


@pytest.fixture(scope="module")
def run(copy):
    """Runs one command after another, all libraries loaded."""
    modules = {module for of_extra in LIBRARIES.values() for module in of_extra.values()}
    with started(copy, *sorted(modules), "matplotlib.pyplot") as run:
        yield run


def check_works(done: dict[str, object], line: str) -> None:
    """The command did its work by sources alone, and reported the line once."""
    assert done["code"] == 0, done
    assert not done["loaded"]
    assert "Traceback" not in done["error"]
    assert done["error"].count(line) == 1, done


def check_refused(done: dict[str, object], line: str) -> None:
    """The command refused to walk, with the line in its note and in its error, and loaded no extension."""
    assert done["code"] == 2, done
    assert not done["loaded"]
    note, error = done["error"].splitlines()
    assert line in note
    assert line in error
    assert "needs compiled kernels" in error


@pytest.mark.sample(1)
@pytest.mark.parametrize("without", EXTENSIONS, indirect=True)
def test_a_command_works_or_refuses(copy, without):
    with started(copy) as run:
        check_works(run(["list", "robots"]), without)
        check_refused(run(["robot", "none.xml"]), without)
        check_refused(run(["sim", "flat"]), without)


@pytest.mark.long
@pytest.mark.parametrize("without", EXTENSIONS, indirect=True)
def test_all_commands_work_or_refuse(copy, run, without):
    for words in WORKS:
        check_works(run(words), without)
    assert without in run(["doctor"])["out"]
    for words in REFUSED:
        check_refused(run(words), without)
    assert not (copy / "out").exists()


@pytest.mark.long
@pytest.mark.parametrize("without", FIRST_OF_ROOM, indirect=True)
def test_slow_commands_work(run, without):
    for words in WORKS_SLOWLY:
        check_works(run(words), without)
