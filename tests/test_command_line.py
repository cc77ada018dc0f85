"""The command line as a process: its arguments, its streams, and what ends it from outside."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer

import plantar
from plantar import cli

PLANTAR = [str(Path(sys.executable).parent / "plantar")]
COMMANDS = typer.main.get_command(cli.app).commands
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="/dev/full and signals as on Linux")


def called(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    """Exit code of the command line, run in this process."""
    monkeypatch.setattr(sys, "argv", ["plantar", *arguments])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    return int(str(ended.value.code))


def shell(command: str, **environment: str) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    env = os.environ | {"PATH": path} | environment
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=env, timeout=600)


def test_the_version_is_the_packages(monkeypatch, capsys):
    assert called(monkeypatch, "--version") == 0
    assert capsys.readouterr().out == f"plantar {plantar.__version__}\n"


def test_a_shell_completes_commands():
    asked = {"_PLANTAR_COMPLETE": "complete_bash", "COMP_WORDS": "plantar sw", "COMP_CWORD": "1"}
    assert shell("plantar", **asked).stdout.split() == ["sweep"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["walk"], ("walk", "plantar --help")),
        (["sim"], ("give a scene", "flat", "s-curve")),
        (["sim", "flat", "--nosuch"], ("--nosuch", "plantar sim --help")),
        (["sim", "flat", "--seed", "x"], ("--seed", "integer")),
        (["analyze", "--compare", "one"], ("--compare", "2 arguments", "plantar analyze --help")),
        (["robot", "mine.toml"], ("mine.toml is no model", "plantar robot check mine.toml")),
        (["list", "formats", "twice", "thrice"], ("thrice",)),
    ],
)
def test_wrong_arguments_are_one_line(arguments, words, monkeypatch, capsys):
    assert called(monkeypatch, *arguments) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert all(word in said.err for word in words), said.err


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_a_command_can_be_copied(name, monkeypatch, capsys):
    """Examples stand in one line where the terminal is wide, and nothing shows how Python writes it."""
    monkeypatch.setenv("COLUMNS", "130")
    assert called(monkeypatch, name, "--help") == 0
    told = capsys.readouterr().out
    examples = re.findall(r"^ *Example: *(.+)", (COMMANDS[name].help or ""), re.MULTILINE)
    assert examples
    assert [e for e in examples if f"Example: {e}\n" not in told] == []
    assert not re.search(r"\[\[|list\[|default: (\(|None)", told), told


def test_no_arguments_are_the_help(monkeypatch, capsys):
    assert called(monkeypatch) == 2
    assert "Commands:" in capsys.readouterr().err


def test_the_simulators_benchmark_without_the_simulator_is_one_line(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "mujoco", None)  # as if it were not installed
    assert called(monkeypatch, "bench", "scenes", "-o", str(tmp_path / "out")) == 2
    said = capsys.readouterr().err
    assert said.startswith("plantar: mujoco is not installed; install it with: ")
    assert "pip install 'mujoco>=" in said
    assert said.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@linux
def test_a_full_disk_behind_stdout_is_one_line():
    done = shell("plantar list formats > /dev/full", PYTHONUNBUFFERED="")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "No space left" in done.stderr


@linux
def test_a_stdout_that_nobody_reads_is_no_message():
    done = shell("plantar list formats | head -c 1 > /dev/null; echo ${PIPESTATUS[0]}", PYTHONUNBUFFERED="1")
    assert done.stdout.strip() in ("0", "141")
    assert done.stderr == ""
    done = shell("(plantar list formats; echo $? >&2) | true", PYTHONUNBUFFERED="")
    assert done.stderr.strip() in ("0", "141")


@linux
def test_an_ascii_terminal_is_written_to(tmp_path):
    (tmp_path / "größe.csv").write_text("t,a,b,c\n0,1,2,3\n0.01,1,2,3\n0.02,1,2,3\n")
    done = shell(
        f"cd {tmp_path} && plantar analyze größe.csv --layout ñ.json; plantar analyze größe.csv --side left -o ñ",
        PYTHONIOENCODING="ascii",
        LC_ALL="C",
    )
    assert "Traceback" not in done.stderr
    assert "\\xf1" in done.stderr  # the layout's name, in what the terminal can show


@linux
@pytest.mark.parametrize(
    ("number", "code", "words"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "SIGTERM")]
)
def test_a_run_that_is_ended_leaves_nothing_and_says_so(tmp_path, number, code, words):
    command = [*PLANTAR, "sim", "flat", "--set", "steps=200", "--plot", "plots", "--record", "run.mcap"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    for _ in range(12000):
        if any(tmp_path.rglob(".plantar-*")) and (tmp_path / "run.mcap").exists():
            break
        time.sleep(0.05)
    process.send_signal(number)
    out, err = process.communicate(timeout=600)
    assert process.returncode == code, err
    assert out == ""
    assert words in err
    assert err.count("\n") == 1
    assert [p.name for p in tmp_path.iterdir() if p.name != "run.mcap"] == []  # a recording is kept as far as it went


@pytest.mark.parametrize(
    "arguments",
    [
        ["sim", "x" * 300],
        ["sim", "flat", "--robot", "x" * 300],
        ["analyze", "x" * 300],
        ["shoe", "x" * 300 + ".stl"],
        ["shoe", "--dimensions", "240x100", "--layout-only", "-o", "x" * 300],
        ["sweep", "x" * 300],
        ["list", "settings", "x" * 300],
    ],
)
def test_an_argument_of_any_length_is_one_line(arguments, monkeypatch, capsys, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert called(monkeypatch, *arguments) == 2
    said = capsys.readouterr()
    assert (said.out, said.err.count("\n")) == ("", 1)
    assert list(tmp_path.iterdir()) == []


def test_a_scene_with_a_typing_error_is_named_alone(monkeypatch, capsys):
    assert called(monkeypatch, "sim", "flatt") == 2
    said = capsys.readouterr().err
    assert "did you mean flat?" in said
    assert "plantar list scenes" in said
    assert len(said) < 150


def test_the_help_begins_with_what_a_new_user_looks_for(monkeypatch, capsys):
    assert called(monkeypatch, "--help") == 0
    first, _, more = capsys.readouterr().out.partition("Commands:")[2].partition("More:")
    names = re.findall(r"^  (\w+)  ", first, re.MULTILINE)
    assert names == ["demo", "shoe", "analyze", "sole", "robot", "sim", "view"]
    assert set(re.findall(r"^  (\w+)  ", more, re.MULTILINE)) == set(COMMANDS) - set(names)
