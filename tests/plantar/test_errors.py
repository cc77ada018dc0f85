import pickle
from importlib.metadata import PackageNotFoundError

import pytest

from plantar import errors

from ..public_names import public_names

NAMES = public_names(errors)
ALL = [getattr(errors, name) for name in NAMES]


@pytest.mark.parametrize("kind", ALL)
def test_every_error_is_a_plantar_error(kind):
    assert issubclass(kind, errors.PlantarError)


def test_tree_in_the_module_docstring_is_the_tree():
    drawn = {}
    parents = [(0, "Exception")]
    for line in errors.__doc__.splitlines():
        name = line.lstrip(" │├└─").split(" ")[0]
        if name not in NAMES:
            continue
        depth = line.index(name)
        while parents[-1][0] >= depth:
            parents.pop()
        drawn[name] = parents[-1][1]
        parents.append((depth, name))
    assert drawn == {kind.__name__: kind.__base__.__name__ for kind in ALL}


def test_a_foreign_file_is_caught_as_a_bad_recording():
    with pytest.raises(errors.RecordingError):
        raise errors.FormatError("not a pedar file")


def test_missing_dependency_gives_the_command_that_installs_what_its_extra_brings(monkeypatch):
    """The libraries themselves: the name `plantar` on an index may be another package."""
    lines = ["numpy>=2.0", "trimesh>=4.5; extra == 'shoes'", 'cadquery>=2.5 ; extra == "shoes"', 'daqp; extra == "sim"']
    monkeypatch.setattr("importlib.metadata.requires", lambda name: lines)
    monkeypatch.setattr("plantar.errors._install", lambda: "pip install")
    error = errors.DependencyError("cadquery", "shoes")
    assert str(error) == "cadquery is not installed; install it with: pip install 'trimesh>=4.5' 'cadquery>=2.5'"
    assert (error.library, error.extra) == ("cadquery", "shoes")
    assert errors.DependencyError.install_command("") == "pip install 'numpy>=2.0'"


def not_installed(name):
    raise PackageNotFoundError(name)


def test_a_checkout_that_is_not_installed_is_what_gets_installed(monkeypatch):
    monkeypatch.setattr("importlib.metadata.requires", not_installed)
    monkeypatch.setattr("plantar.errors._install", lambda: "pip install")
    assert errors.DependencyError.install_command("sim").startswith("pip install '.[sim]'")


@pytest.mark.parametrize(
    ("found", "own_pip", "begins"),
    [
        ("/home/a/venv/bin/pip", True, "pip install '"),
        ("/usr/bin/pip", True, "/home/a/venv/bin/python -m pip install '"),
        (None, True, "/home/a/venv/bin/python -m pip install '"),
        ("/usr/bin/pip", False, "uv pip install --python /home/a/venv/bin/python '"),
    ],
)
def test_the_command_installs_for_the_python_that_runs(found, own_pip, begins, monkeypatch):
    monkeypatch.setattr("sys.executable", "/home/a/venv/bin/python")
    monkeypatch.setattr("shutil.which", lambda name: found)
    monkeypatch.setattr("importlib.metadata.requires", lambda name: ["gymnasium>=1.0; extra == 'gym'"])
    monkeypatch.setattr("importlib.metadata.version", (lambda name: "25.0") if own_pip else not_installed)
    assert errors.DependencyError.install_command("gym").startswith(begins)


@pytest.mark.parametrize("kind", [k for k in ALL if k is not errors.DependencyError])
def test_errors_cross_processes(kind):
    copy = pickle.loads(pickle.dumps(kind("what is wrong")))
    assert type(copy) is kind
    assert str(copy) == "what is wrong"


def test_missing_dependency_crosses_processes():
    copy = pickle.loads(pickle.dumps(errors.DependencyError("mujoco", "sim")))
    assert (str(copy), copy.extra) == (str(errors.DependencyError("mujoco", "sim")), "sim")
