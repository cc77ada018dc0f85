"""What the README and the documents show works: commands run, examples run, links lead somewhere."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LONG = tuple(f"plantar {c}" for c in ("demo", "sweep", "bench", "sim", "shoe", "analyze out/flat.mcap"))
"""Commands that only `make test-all` runs; other tests walk less far, build a smaller shoe, sweep and measure."""


def blocks(text: str, language: str) -> list[str]:
    """Fenced code blocks of one language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands(text: str) -> list[str]:
    """Shell commands of a document, without comments."""
    lines = "".join(blocks(text, "sh")).replace("\\\n", " ").splitlines()
    return [line.partition(" #")[0].strip() for line in lines if line.strip() and not line.startswith("#")]


COMMANDS = commands(README)


@pytest.fixture(scope="module")
def user(tmp_path_factory):
    """A folder as after a clone, in which the commands run one after the other."""
    folder = tmp_path_factory.mktemp("readme")
    for name in ("examples", "docs"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "out").mkdir()
    return folder


def run(command: list[str], cwd: Path) -> subprocess.CompletedProcess[str]:
    scripts = Path(sys.executable).parent
    env = os.environ | {"PATH": f"{scripts}{os.pathsep}{os.environ.get('PATH', '')}"}
    return subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True)


def test_there_is_something_to_run():
    assert {"make demo", "make test"} <= set(COMMANDS)
    for word in ("shoe", "sim", "analyze"):
        assert [c for c in COMMANDS if c.startswith(f"plantar {word} ")], f"the README shows no 'plantar {word}'"
    assert blocks(README, "python")


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(c, id=c, marks=[pytest.mark.long] if c.startswith(LONG) else [])
        for c in dict.fromkeys(COMMANDS)
        if not c.startswith("make")
    ],
)
def test_a_command_of_the_readme_runs(user, command):
    done = run(shlex.split(command), user)
    assert done.returncode == 0, f"exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    words = shlex.split(command)
    if "-o" in words:
        made = user / words[words.index("-o") + 1]
        assert any(made.iterdir()), f"{made} is empty"


@pytest.mark.parametrize(
    "command", sorted({c for d in DOCUMENTS for c in commands(d.read_text()) if c.startswith("make")})
)
def test_a_make_target_exists(command):
    done = run([*shlex.split(command), "--dry-run"], ROOT)
    assert done.returncode == 0, done.stderr
    listed = run(["make", "help"], ROOT).stdout
    assert f"{command} " in listed


# The first walks, records, analyses and views, as the commands do in test_commands.py and viewer/.
@pytest.mark.parametrize("number", [pytest.param(0, marks=pytest.mark.long), *range(1, len(blocks(README, "python")))])
def test_an_example_of_the_readme_runs(user, number):
    done = run([sys.executable, "-W", "error", "-c", blocks(README, "python")[number]], user)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()
    assert "None" not in done.stdout, "the skin of the example carries no load"


def test_each_row_of_the_table_of_things_names_what_there_is():
    """A command with a scene, a paper and options that exist; its figure is checked as a link below."""
    table = README.partition("## One command for each thing")[2].partition("## Start")[0]
    found = [shlex.split(c) for c in re.findall(r"`((?:plantar|python) [^`]+)`", table)]
    assert len(found) >= 15
    scenes = run([sys.executable, "-m", "plantar", "list", "scenes"], ROOT).stdout
    helped: dict[str, str] = {}
    for program, word, *rest in found:
        if program == "python":
            assert (ROOT / word).exists()
            continue
        if word not in helped:
            helped[word] = run([sys.executable, "-m", "plantar", word, "--help"], ROOT).stdout
        assert [option for option in rest if option.startswith("--") and option not in helped[word]] == []
        assert word != "sim" or re.search(rf"^ *{rest[0]} ", scenes, re.MULTILINE), rest


def test_the_table_of_commands_is_the_command_lines():
    listed = set(re.findall(r"^\| `plantar (\w+)` \|", README, re.MULTILINE))
    helped = run([sys.executable, "-m", "plantar", "--help"], ROOT).stdout.partition("Commands:")[2]
    assert listed == set(re.findall(r"^  (\w+)  ", helped, re.MULTILINE))


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda d: str(d.relative_to(ROOT)))
def test_links_and_pictures_lead_somewhere(document):
    text = re.sub(r"^```.*?^```$", "", document.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    targets = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text)
    missing = [t for t in targets if "://" not in t and not (document.parent / t).exists()]
    assert missing == []


def test_the_changelog_knows_the_version():
    import plantar

    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(r"^## \[(Unreleased|" + re.escape(plantar.__version__) + r")\]", text, re.MULTILINE)
