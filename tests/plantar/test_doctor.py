"""What the doctor says of libraries that are there, missing or broken."""

import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError

import pytest
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


FAKES = {
    "gone": "raise ModuleNotFoundError(\"No module named 'gone'\", name='gone')",
    "without_gl": "raise ImportError('libGL.so.1: cannot open shared object file: No such file or directory')",
    "of_another_numpy": "raise ImportError('numpy.core.multiarray failed to import')",
    "needs_shapely": "raise ModuleNotFoundError(\"No module named 'shapely'\", name='shapely')",
    "sound": "",
}


@pytest.mark.parametrize(
    ("module", "distribution", "stated", "extra", "problem", "remedy"),
    [
        ("absent", "gymnasium", None, "gym", "missing", None),
        (
            "gone",
            "scipy",
            "1.17",
            "",
            "cannot be loaded (its files are not there)",
            "pip install --force-reinstall scipy",
        ),
        ("without_gl", "cadquery", "2.8", "shoes", "libGL.so.1: cannot open", "sudo apt-get install libgl1"),
        ("of_another_numpy", "mujoco", "3.12", "sim", "multiarray failed", "pip install --force-reinstall mujoco"),
        ("needs_shapely", "trimesh", "5.0", "sim", "No module named 'shapely'", "--force-reinstall shapely"),
        ("sound", "mujoco", "3.9.1", "sim", "too old, mujoco>=3.10 is needed", "pip install 'mujoco>=3.10'"),
    ],
)
def test_six_broken_environments_are_told_apart_each_with_what_mends_it(
    module, distribution, stated, extra, problem, remedy, tmp_path, monkeypatch
):
    def version(name):
        if stated is None:
            raise PackageNotFoundError(name)
        return stated

    for name, code in FAKES.items():
        (tmp_path / f"{name}.py").write_text(code)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("plantar.doctor.version", version)
    found = examine({extra: {distribution: module}})
    [library] = found["libraries"]
    assert problem in library["problem"]
    assert found["holds"] == (problem == "missing")
    if remedy is None:
        assert library["remedy"] is None
        assert "pip install 'gymnasium>=1.0'" in doctor_text(found)
    else:
        assert remedy in library["remedy"]
        assert f"repair it: {library['remedy']}" in doctor_text(found)
    monkeypatch.delitem(sys.modules, module, raising=False)


def test_a_library_that_is_new_enough_is_well(tmp_path, monkeypatch):
    (tmp_path / "sound.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr("plantar.doctor.version", lambda name: "3.10.0rc1")
    assert examine({"sim": {"mujoco": "sound"}})["holds"]


@pytest.mark.sample(1)
@pytest.mark.parametrize("library", ["typer", "rich"])
def test_the_command_without_its_own_library_is_one_line_that_installs_it(library):
    code = f"import sys; sys.modules[{library!r}] = None; sys.argv = ['plantar', 'doctor']"
    absent = f"{code}; import plantar.__main__ as m; m.main()"
    done = subprocess.run([sys.executable, "-c", absent], capture_output=True, text=True)
    assert "Traceback" not in done.stderr
    assert done.returncode in (1, 2)
    told = done.stderr + done.stdout
    assert re.search("install 'numpy>=|force-reinstall rich", told)


def test_the_command_says_how_things_stand(monkeypatch):
    monkeypatch.setattr("plantar.doctor.examine", lambda: examine({"": LIBRARIES[""]}))
    done = CliRunner().invoke(cli.app, ["doctor", "--json"])
    assert done.exit_code == 0
    assert json.loads(done.stdout)["python"].startswith("3.")
    monkeypatch.setattr("plantar.doctor.examine", lambda: examine({"": {"none-such": "none_such"}}))
    assert CliRunner().invoke(cli.app, ["doctor"]).exit_code == 1
