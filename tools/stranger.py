"""Try what README, docs and examples show as a stranger would: the wheel alone, an empty folder, nothing imported.

python tools/stranger.py [--extras "" sim shoes sim,gym] [--wheel FILE] [--python PYTHON] [--only TEXT] [--limit S]

The wheel is built once and installed in a fresh environment for each set of extras. Every fenced block of Python and of
the shell, every example and every door of the library then runs in a process of its own, a page's in one folder, in
order. Each must end in one of five ways: done; still at work when its time is over; the line that gives the command for
a library that none of the installed extras brings; the absence of one; or one line on a file of the user's that is not
there. Anything else is printed, and the exit code is 1. Each is listed on stderr with its processor time. That time
counts, and the time in which a process waits for something else than a processor: a busy machine ends nothing early.
"""

import argparse
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from plantar.common.optional_library import LIBRARIES  # noqa: E402

PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
_DEPENDENCY = re.compile(r"(\w+)[\w.]* is not installed; install it with: .*pip install .*'")
_NEEDS_A_FILE = re.compile(
    r"(cannot be read|does not exist|No such file or directory|Error opening file|give a \w+|^usage: )", re.MULTILINE
)
_NOT_RUN = (
    "make ",
    "pip ",
    "git ",
    "python3 -m venv",
    ". .venv",
    "source ",
    "cd ",
    "sudo ",
    "dask ",
    "uv ",
    "#",
    "cat ",
)
_BROUGHT = {"shoes": {"OCP"}}  # by an extra's libraries in turn
_OTHER_LIBRARIES = {"torch", "jax", "mjlab", "pandas", "mine", "mink", "unitree_sdk2py", "imageio"}
"""Of pages on other people's packages, or yours."""


DOORS = (
    "plantar.read(insole)",
    "plantar.analyse(insole)",
    "plantar.sole(robot, 8.0)",
    "plantar.view([robot], 'view.html')",
    "plantar.load_robot('h1')",
    "plantar.load_controller('h1')",
    "plantar.load_scene('flat')",
    "plantar.run('flat', steps=2)",
    "plantar.mujoco.Skin(body='foot')",
    "plantar.shoes.foot_from_dimensions('box', length=0.25, width=0.1)",
)
"""Doors with arguments that are there; `insole` and `robot` are the recordings that each wheel has."""
_BEFORE_A_DOOR = """
import plantar, plantar.shoes
from importlib.resources import files
insole, robot = (files("plantar.commands") / "small_demo" / name for name in ("insole.asc", "robot.mcap"))
"""


class Block(NamedTuple):
    """A block of a page, or an example: its `place`, `language` ("python" or "sh") and `text`."""

    place: str
    language: str
    text: str


def blocks_of(page: Path) -> Iterator[Block]:
    """Fenced blocks of Python and of the shell on a page, in order."""
    text = page.read_text(encoding="utf-8")
    for found in re.finditer(r"^```(python|sh|bash)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        line = text.count("\n", 0, found.start()) + 1
        language = "python" if found[1] == "python" else "sh"
        yield Block(f"{page.relative_to(ROOT)}:{line}", language, found[2])


def lines_of(block: Block) -> list[str]:
    """Commands of a block of the shell that are tried: none that sets up an environment; a loop is one."""
    commands = re.findall(r"^for (?s:.*?)^done$|^.*\S.*$", block.text.replace("\\\n", " "), re.MULTILINE)
    return [command.partition(" #")[0].strip() for command in commands if not command.startswith(_NOT_RUN)]


def absent_libraries(extras: str) -> set[str]:
    """Modules that an environment with some extras, such as "sim,gym", may lack."""
    modules = {extra: {*found.values(), *_BROUGHT.get(extra, ())} for extra, found in LIBRARIES.items()}
    brought = {module for extra in ("", *extras.split(",")) for module in modules.get(extra, ())}
    return {module for found in modules.values() for module in found} - brought | _OTHER_LIBRARIES


def outcome(done: subprocess.CompletedProcess[str], absent: set[str]) -> str:
    """How a process ended: "done", "dependency", "library", "file" or "broken"; `absent`: libraries it may lack.

    A line that asks for a library which is there would mend nothing when pasted: broken.
    """
    if done.returncode in (0, 1) and "Traceback" not in done.stderr:
        return "done"  # 1: a walk that fell, or a check that does not hold
    last = done.stderr.strip().splitlines()[-1:] or [""]
    missing = _DEPENDENCY.search(last[0])
    if missing is not None:
        return "dependency" if missing[1] in absent else "broken"
    module = re.search(r"No module named '(\w+)", last[0])
    if module is not None and module[1] in absent:
        return "library"
    if _NEEDS_A_FILE.search(last[0]):
        return "file"
    return "broken"


class Stranger:
    """An environment with the wheel, and what is tried in it; `broken` gathers what ended otherwise."""

    def __init__(self, python: Path, extras: str, limit: float = 300.0) -> None:
        self._absent = absent_libraries(extras)
        self._limit = limit
        clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV", "PLANTAR"))}
        path = f"{python.parent}{os.pathsep}{clean.get('PATH', '')}"
        self.python = python
        self.environment = clean | {"PATH": path, "MUJOCO_GL": "egl"}
        self.counts: dict[str, int] = {}
        self.broken: list[str] = []
        self._before = 0.0

    def try_pages(self, only: str) -> None:
        """Each page's blocks in a folder of its own, which has the examples as a clone has."""
        for page in PAGES:
            with tempfile.TemporaryDirectory() as folder:
                (Path(folder) / "examples").symlink_to(ROOT / "examples")
                run: list[str] = []
                before: list[str] = []
                for block in blocks_of(page):
                    ended = "done"
                    if only in block.place:
                        ended = self._try_block(block, ("".join(run), "".join(before)), Path(folder))
                    if block.language == "python":
                        before.append(block.text)
                        run += [block.text] if ended == "done" else []

    def try_examples(self, only: str) -> None:
        """Each example without arguments."""
        for example in sorted((ROOT / "examples").glob("*.py")):
            place = str(example.relative_to(ROOT))
            if only in place:
                with tempfile.TemporaryDirectory() as folder:
                    self._judge(place, self._run([str(self.python), str(example)], Path(folder)))

    def try_doors(self, only: str) -> None:
        """Each door, called with what is there."""
        for door in DOORS:
            if only in door:
                with tempfile.TemporaryDirectory() as folder:
                    self._judge(door, self._run([str(self.python), "-c", _BEFORE_A_DOOR + door], Path(folder)))

    def _try_block(self, block: Block, before: tuple[str, ...], folder: Path) -> str:
        """Try a block, which may go on where those before it ended: those that ran, else all; returns how it ended."""
        if block.language == "sh":
            ended = [
                self._judge(f"{block.place} {line}", self._run(["sh", "-c", line], folder)) for line in lines_of(block)
            ]
            return ended[-1] if ended else "done"
        done = self._run([str(self.python), "-c", block.text], folder)
        for text in before:
            if done is None or "NameError" not in done.stderr:
                break
            done = self._run([str(self.python), "-c", text + block.text], folder)
        return self._judge(block.place, done)

    def _run(self, command: list[str], folder: Path) -> subprocess.CompletedProcess[str] | None:
        self._before = _children_s()
        pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        started = subprocess.Popen(
            command, cwd=folder, env=self.environment, text=True, start_new_session=True, **pipes
        )
        spent, used, seen = 0.0, 0.0, time.monotonic()
        while spent < self._limit:
            try:
                out, err = started.communicate(timeout=min(1.0, self._limit - spent))
            except subprocess.TimeoutExpired:
                now, (used_now, wants_processor) = time.monotonic(), _session_time(started.pid)
                spent += max(0.0, used_now - used) if wants_processor else now - seen
                used, seen = used_now, now
            else:
                return subprocess.CompletedProcess(command, started.returncode, out, err)
        _end(started)
        return None

    def _judge(self, place: str, done: subprocess.CompletedProcess[str] | None) -> str:
        ended = "at work" if done is None else outcome(done, self._absent)
        self.counts[ended] = self.counts.get(ended, 0) + 1
        print(f"{_children_s() - self._before:7.1f} s  {ended:10}  {place}", file=sys.stderr, flush=True)
        if done is not None and ended == "broken":
            last = "\n    ".join(done.stderr.strip().splitlines()[-3:])
            self.broken.append(f"{place}: exit {done.returncode}\n    {last}")
        return ended


def _children_s() -> float:
    """Processor time of the processes that ended so far."""
    used = os.times()
    return used.children_user + used.children_system


def _session_time(session: int) -> tuple[float, bool]:
    """Processor time in s of a session's processes and their ended children, and whether one of its threads is ready.

    Where the system has no /proc none is ever ready, so that the clock's time counts.
    """
    ticks = 0
    ready = False
    for process in Path("/proc").glob("[0-9]*"):
        try:
            fields = _stat(process)
            if int(fields[3]) == session:
                ticks += sum(map(int, fields[11:15]))  # of itself and of its children, as user and in the kernel
                ready = ready or any(_stat(thread)[0] == "R" for thread in (process / "task").iterdir())
        except OSError:  # it ended meanwhile
            continue
    return ticks / os.sysconf("SC_CLK_TCK") if ticks else 0.0, ready


def _stat(process: Path) -> list[str]:
    """Fields of a process or thread behind its name, which may hold blanks: state, parent, group, session, ..."""
    return (process / "stat").read_text().rpartition(")")[2].split()


def _end(started: subprocess.Popen[str]) -> None:
    """End a process with those that it started, its workers, which hold its pipes open."""
    if os.name == "nt":
        started.kill()
    else:
        os.killpg(started.pid, signal.SIGKILL)
    started.communicate()


def built_wheel(folder: Path) -> Path:
    """The wheel of this checkout."""
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(folder), str(ROOT)]
    subprocess.run(command, check=True)
    return next(folder.glob("*.whl"))


def installed(wheel: Path, extras: str, folder: Path) -> Path:
    """Python of a fresh environment with a wheel and some of its extras."""
    venv.create(folder, with_pip=True)
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    wanted = f"{wheel}[{extras}]" if extras else str(wheel)
    subprocess.run([str(python), "-m", "pip", "install", "--quiet", wanted], check=True)
    return python


def main() -> int:
    """Try everything in every environment; 1 where something is broken."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--extras", nargs="*", default=["", "sim", "shoes", "sim,gym"])
    parser.add_argument("--wheel", type=Path, help="built already")
    parser.add_argument("--python", type=Path, help="of an environment that has it with the first extras already")
    parser.add_argument("--only", default="", help="part of the place of what is tried")
    parser.add_argument("--limit", type=float, default=300.0, metavar="S", help="of work or waiting, each")
    given = parser.parse_args()
    broken = 0
    with tempfile.TemporaryDirectory() as made:
        wheel = None if given.python else given.wheel or built_wheel(Path(made))
        for number, extras in enumerate(given.extras[:1] if wheel is None else given.extras):
            python = given.python if wheel is None else installed(wheel, extras, Path(made) / str(number))
            stranger = Stranger(python.absolute(), extras, given.limit)
            stranger.try_doors(given.only)
            stranger.try_pages(given.only)
            stranger.try_examples(given.only)
            print(f"[{extras or 'bare'}]", stranger.counts)
            print("\n".join(stranger.broken), flush=True)
            broken += len(stranger.broken)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
