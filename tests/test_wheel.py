"""The wheel as a user gets it: built, installed in an environment of its own, and used away from the checkout."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def run(*command: str | Path, cwd: Path, check: bool = True, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a command in an environment that knows nothing of the checkout, with some more variables."""
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV", "PLANTAR"))}
    done = subprocess.run([str(c) for c in command], cwd=cwd, env=clean | more, capture_output=True, text=True)
    assert not check or done.returncode == 0, f"{command}: exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def copied_source(folder: Path, *, generated: bool, compiled: bool) -> Path:
    """A copy of the checkout to build from, so that the checkout stays as it is."""
    source = folder / "source"
    library = Path("build") / f"lib.{sysconfig.get_platform()}-{sys.implementation.cache_tag}"
    kernels = Path("plantar") / "kernels"
    places = {path: path for path in tracked()}
    if generated:
        places |= {c.relative_to(ROOT): c.relative_to(ROOT) for c in (ROOT / "build/cython" / kernels).glob("*/*.c")}
    if compiled:
        extensions = [p for p in (ROOT / kernels).glob("*/*") if ends(p) & set(EXTENSION_SUFFIXES)]
        places |= {p.relative_to(ROOT): library / p.relative_to(ROOT) for p in extensions}
    for path, place in places.items():
        (source / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / path, source / place)  # with its time, by which a build tells what is stale
    return source


def built_wheel(folder: Path, source: Path, **more: str) -> Path:
    """The wheel of a copy of the checkout, built with some more variables."""
    run(sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder, source, cwd=folder, **more)
    [built] = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The wheel of what is in the checkout.

    `make test` has compiled the kernels by the same setup.py just before; only what is stale is compiled once more.
    """
    folder = tmp_path_factory.mktemp("wheel")
    return built_wheel(folder, copied_source(folder, generated=True, compiled=True), CFLAGS="-O0")


def ends(path: Path) -> set[str]:
    """All endings of a file's name: {".so", ".cpython-311-x86_64-linux-gnu.so"} of an extension module."""
    parts = path.name.split(".")
    return {"." + ".".join(parts[i:]) for i in range(1, len(parts))}


def tracked() -> list[Path]:
    """Files of the distribution in the checkout."""
    built = {"__pycache__", ".stamp", *EXTENSION_SUFFIXES}
    inside = [p for p in (ROOT / "plantar").rglob("*") if p.is_file() and not built & {*p.parts, *ends(p)}]
    return [
        p.relative_to(ROOT)
        for p in [*inside, *(ROOT / n for n in ("setup.py", "pyproject.toml", "README.md", "LICENSE"))]
    ]


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """The scripts folder of an environment with the wheel in it.

    The libraries that Plantar needs come from this environment by a path file. Path files found in a folder that is
    itself added by one are not read, so the checkout, which is there as an editable install, stays out.
    """
    folder = tmp_path_factory.mktemp("clean")
    venv.create(folder, with_pip=False, symlinks=os.name != "nt")
    scripts = folder / ("Scripts" if os.name == "nt" else "bin")
    here = sysconfig.get_paths(vars={"base": str(folder), "platbase": str(folder)})["purelib"]
    pip = (sys.executable, "-m", "pip", "--python", scripts / "python", "--disable-pip-version-check")
    run(*pip, "install", "--quiet", "--no-deps", "--no-index", wheel, cwd=folder)
    (Path(here) / "libraries.pth").write_text(sysconfig.get_paths()["purelib"] + "\n")
    return scripts


def extensions_in(wheel: Path) -> set[str]:
    """Names of the extension modules in a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        return {n for n in archive.namelist() if ends(Path(n)) & set(EXTENSION_SUFFIXES)}


def kernels_that_compile() -> set[str]:
    """All kernels, by path without ending, where there are Cython and a compiler; else none."""
    compiles = importlib.util.find_spec("Cython") is not None and shutil.which("cc") is not None
    pairs = (p for p in (ROOT / "plantar" / "kernels").glob("*/*.pxd") if p.with_suffix(".py").exists())
    sources = {p.relative_to(ROOT).with_suffix("").as_posix() for p in pairs} | {"plantar/kernels/base/memoryviews"}
    return sources if compiles else set()


@pytest.mark.long
def test_a_fresh_clone_builds_a_wheel_with_every_kernel(tmp_path):
    built = built_wheel(tmp_path, copied_source(tmp_path, generated=False, compiled=False), CFLAGS="-O0")
    assert {n.partition(".")[0] for n in extensions_in(built)} == kernels_that_compile()


@pytest.mark.long
def test_the_sdist_holds_what_the_wheel_is_built_of_in_less_than_2_mb(tmp_path):
    unwanted = shutil.ignore_patterns(".git", ".venv", "out", "build", "dist", ".*_cache", ".hypothesis", "__pycache__")
    source = shutil.copytree(ROOT, tmp_path / "source", ignore=unwanted)
    run(sys.executable, "-m", "build", "--sdist", "--no-isolation", "--outdir", tmp_path, source, cwd=tmp_path)
    [built] = tmp_path.glob("*.tar.gz")
    with tarfile.open(built) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {p.as_posix() for p in tracked()} <= names
    assert {"CHANGELOG.md", "CITATION.cff"} <= names
    assert not {name.partition("/")[0] for name in names} & {"tests", "docs", "benchmarks", "examples", "tools"}
    assert built.stat().st_size < 2e6


def test_the_wheel_holds_code_and_data(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = {n for n in archive.namelist() if ".dist-info/" not in n}
    data = {".toml", ".xml", ".json", ".html", ".css", ".js", ".typed", ".bin", ".txt", ".c", ".h"}
    wanted = {
        p.as_posix()
        for p in tracked()
        if len(p.parts) > 1 and (p.suffix in {".py", ".pxd", *data} or "small_demo" in p.parts)
    }
    stamp = {"plantar/kernels/compiled.stamp"} if kernels_that_compile() else set()
    assert names - extensions_in(wheel) == wanted | stamp
    assert {n.partition("/")[0] for n in names} == {"plantar"}
    assert {n.partition(".")[0] for n in extensions_in(wheel)} == kernels_that_compile()
    assert "plantar/py.typed" in names
    assert any(n.startswith("plantar/robots/") and n.endswith(".toml") for n in names)
    assert any(n.startswith("plantar/sim/scenes/") and n.endswith(".toml") for n in names)


def test_the_wheel_names_its_license_and_its_extras(wheel):
    with zipfile.ZipFile(wheel) as archive:
        [info] = [n for n in archive.namelist() if n.endswith(".dist-info/METADATA")]
        metadata = archive.read(info).decode()
        assert any(n.endswith("licenses/LICENSE") for n in archive.namelist())
    assert "License-Expression: Apache-2.0" in metadata
    needed = [line for line in metadata.splitlines() if line.startswith("Requires-Dist:") and "extra" not in line]
    assert not [line for line in needed if any(heavy in line for heavy in ("cadquery", "mujoco", "trimesh"))]


def test_it_runs_from_the_environment_and_not_from_the_checkout(installed, tmp_path):
    code = "from plantar import cli, gait, shoes, sim, wholebody\n"
    code += "for m in (cli, gait, shoes, sim, wholebody): print(m.__file__)"
    files = run(installed / "python", "-c", code, cwd=tmp_path).stdout.splitlines()
    assert len(files) == 5
    assert all(Path(f).is_relative_to(installed.parent) for f in files), files


def test_the_installed_kernels_are_compiled_and_the_sources_do_the_same(installed, tmp_path):
    code = "from plantar import kernels, polygon; print(polygon.area([[0, 0], [2, 0], [2, 1]]), kernels.compiled)"
    assert run(installed / "python", "-c", code, cwd=tmp_path).stdout.startswith("1.0")
    forced = f"import os; os.environ['PLANTAR_KERNELS'] = 'python'; {code}"
    assert run(installed / "python", "-c", forced, cwd=tmp_path).stdout.split() == ["1.0", "False"]


@pytest.mark.long
def test_without_a_compiler_it_installs_and_works(tmp_path):
    """Built from a copy with a compiler that does not exist: the wheel holds the sources alone, and they run."""
    source = copied_source(tmp_path, generated=True, compiled=False)
    build = "import os, sys; os.environ['CC'] = 'no-such-compiler'; from build.__main__ import main; main(sys.argv[1:])"
    run(sys.executable, "-c", build, "--wheel", "--no-isolation", "--outdir", tmp_path, source, cwd=tmp_path)
    [built] = tmp_path.glob("*.whl")
    with zipfile.ZipFile(built) as archive:
        assert not extensions_in(built)
        archive.extractall(tmp_path / "installed")
    code = "from plantar import kernels, polygon; print(polygon.area([[0, 0], [2, 0], [2, 1]]), kernels.compiled)"
    assert run(sys.executable, "-c", code, cwd=tmp_path / "installed").stdout.split() == ["1.0", "False"]


def test_a_users_own_files_are_left_alone(installed, tmp_path):
    """A user's folder may hold the names that the checkout has at its top, and be on the path."""
    for folder in ("sim", "gait", "wholebody"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "__init__.py").write_text(f"raise SystemExit('{folder} of the user was run')")
    for name in ("cli", "shoes"):
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('{name} of the user was run')")
    for command in ([installed / "plantar"], [installed / "python", "-m", "plantar"]):
        for words in (["--version"], ["list", "scenes"], ["list", "robots"], ["shoe", "--help"]):
            run(*command, *words, cwd=tmp_path, PYTHONPATH=str(tmp_path))
    code = "import plantar.batch, plantar.gait.controller, plantar.sim.run.runner, plantar.wholebody.stack"
    run(installed / "python", "-c", code, cwd=tmp_path, PYTHONPATH=str(tmp_path))


def test_help_and_lists(installed, tmp_path):
    assert "analyze" in run(installed / "plantar", "--help", cwd=tmp_path).stdout
    assert "flat" in run(installed / "plantar", "list", "scenes", cwd=tmp_path).stdout
    robots = json.loads(run(installed / "plantar", "list", "robots", "--json", cwd=tmp_path).stdout)
    assert "h1" in [r["name"] for r in robots["robots"]]


def test_one_analysis(installed, tmp_path):
    """A made-up walk on insoles: each foot stands 0.6 s in each second, the right one half a second later."""
    rate, cells = 50, 99
    lines = ["Novel export", "pressure values in kPa", f"scanning rate [Hz]: {rate}"]
    lines.append("time[secs]\t" + "\t".join(str(1 + i % cells) for i in range(2 * cells)))
    for frame in range(7 * rate):
        time = frame / rate
        load = [100.0 if (time + 0.2 + shift) % 1.0 < 0.6 and time > 0.8 else 0.0 for shift in (0.0, 0.5)]
        lines.append("\t".join([f"{time:.3f}", *[f"{load[0]:.1f}"] * cells, *[f"{load[1]:.1f}"] * cells]))
    (tmp_path / "walk.asc").write_text("\n".join(lines) + "\n")
    done = run(installed / "plantar", "analyze", "walk.asc", "--json", "--figures", "-o", "out", cwd=tmp_path)
    result = json.loads(done.stdout)
    assert result["frames"] == 7 * rate
    assert result["rate_hz"] == pytest.approx(rate)
    for side in ("left", "right"):
        assert 5 <= result["feet"][side]["steps"] <= 6
    assert {"metrics.json", "steps.csv", "report.html"} <= {p.name for p in (tmp_path / "out").iterdir()}


def test_bad_input_is_one_line_and_exit_code_2(installed, tmp_path):
    done = run(installed / "plantar", "analyze", "nothing.asc", cwd=tmp_path, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.strip().splitlines()) == 1
    assert "nothing.asc" in done.stderr
    assert list(tmp_path.iterdir()) == []
