"""What the doctor says of libraries that are there, missing or broken."""

import json
import re
import tomllib

from typer.testing import CliRunner

from plantar import __version__, cli
from plantar.doctor import LIBRARIES, PURPOSES, doctor_text, examine


def test_it_knows_every_library_that_is_declared(repository):
    project = tomllib.loads((repository / "pyproject.toml").read_text())["project"]
    declared = {"": project["dependencies"]} | project["optional-dependencies"]
    for extra, libraries in LIBRARIES.items():
        assert [re.split("[>=]", line)[0] for line in declared[extra]] == list(libraries)
    assert set(declared) - set(LIBRARIES) == {"all", "bench", "dev", "docs"}
    assert set(PURPOSES) == set(LIBRARIES)


def test_all_is_well_where_all_is_installed():
    found = examine({"": LIBRARIES[""]})
    assert found["plantar"] == __version__
    assert found["holds"]
    assert all(f["version"] and f["problem"] is None for f in found["libraries"])
    assert "numpy" in doctor_text(found)
    assert "get them" not in doctor_text(found)


def test_an_extra_that_is_missing_is_no_failure_and_a_broken_library_is(tmp_path, monkeypatch):
    missing = examine({"sim": {"no-such-library": "no_such_library"}})
    assert missing["holds"]
    assert "no-such-library missing" in doctor_text(missing)
    assert "pip install 'mujoco>=" in doctor_text(missing)
    assert not examine({"": {"no-such-library": "no_such_library"}})["holds"]
    (tmp_path / "broken_library.py").write_text("raise OSError('libGL.so.1: cannot open shared object file')")
    monkeypatch.syspath_prepend(tmp_path)
    broken = examine({"sim": {"numpy": "broken_library"}})
    assert not broken["holds"]
    assert "cannot be loaded" in doctor_text(broken)
    assert "libGL.so.1" in doctor_text(broken)


def test_the_command_says_how_things_stand(monkeypatch):
    monkeypatch.setattr("plantar.doctor.examine", lambda: examine({"": LIBRARIES[""]}))
    done = CliRunner().invoke(cli.app, ["doctor", "--json"])
    assert done.exit_code == 0
    assert json.loads(done.stdout)["python"].startswith("3.")
    monkeypatch.setattr("plantar.doctor.examine", lambda: examine({"": {"none-such": "none_such"}}))
    assert CliRunner().invoke(cli.app, ["doctor"]).exit_code == 1
