"""What all tests share: soles to test on, and the switch to the real data."""

import os

# Before numpy loads: threads of one small solve wait for each other, ten times as long beside another worker.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import gc
import hashlib
import re
import signal
import time
import warnings
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import settings

from plantar import hex_layout, kernels
from plantar.common.console.ending import one_line
from plantar.plotting import save_figure

# MuJoCo looks for it when it is first imported, and an introduced robot is drawn. What tests start says so itself.
if "MUJOCO_GL" not in os.environ and find_spec("mujoco") is not None:
    os.environ["MUJOCO_GL"] = "egl"
    import_module("mujoco")
    del os.environ["MUJOCO_GL"]


# Interpreted, the simulations would take hours.
if kernels.problem and kernels.problem != "none of them is compiled":
    pytest.exit(kernels.form_text(), returncode=4)

# For its doctests pytest loads a module from the source; a kernel that was not yet loaded would stay interpreted and
# lack what compiled ones share among themselves.
for kernel in kernels.KERNELS:
    import_module(f"plantar.kernels.{kernel}")

DRAW = os.environ.get("PLANTAR_TEST_DRAW", "0")
"""Which cases and seeds are drawn: with any other text another set, which has to pass as well."""


def beyond_sample(items: list[pytest.Item]) -> list[pytest.Item]:
    """Cases that the draw leaves to the long tests: of a test marked `sample(5)` all but five.

    `sample(1, each="robot")` draws one for each value of that argument, `sample(8, of="file")` eight tests of a file
    that are not long anyway. The draw is by the case's name: the same each time, and one more case changes at most one
    of those drawn.
    """
    cases = defaultdict(list)
    for item in items:
        mark = item.get_closest_marker("sample")
        if mark is None:
            continue
        if mark.kwargs.get("of") == "file":
            if item.get_closest_marker("long") is None:
                cases[str(item.path), "", mark.args[0]].append(item)
            continue
        value = repr(item.callspec.params[mark.kwargs["each"]]) if "each" in mark.kwargs else ""
        cases[item.nodeid.partition("[")[0], value, mark.args[0]].append(item)
    for (*_, count), found in cases.items():
        found.sort(key=lambda item: hashlib.sha256(f"{item.nodeid} {DRAW}".encode()).digest())
        del found[:count]
    return [item for found in cases.values() for item in found]


SLOW = ("tests/sim/", "tests/shoes/", "tests/test_", "tests/gait/analysis/", "tests/plantar/formats/")
"""Where files lie of which some take half a minute: they simulate, build solids, or start processes."""


@pytest.hookimpl(tryfirst=True)  # before `-m "not long"` takes the long ones away
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Cases beyond the drawn ones are long; slow files come first, so that the workers end together."""
    for item in beyond_sample(items):
        item.add_marker(pytest.mark.long)
    items.sort(key=lambda item: not item.path.relative_to(config.rootpath).as_posix().startswith(SLOW))


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Look for no garbage while tests are collected, and later not among them.

    Ten thousand tests are millions of objects that stay; looking through them again and again takes a third of the
    time.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Of `--dist loadfile`, one that goes on when a worker dies."""
    if config.getvalue("dist") != "loadfile":
        return None
    return import_module(".scheduler", __package__).FilesAtOnce(config, log)


@pytest.fixture(autouse=True)
def _same_environment(monkeypatch):
    """Commands that run in this process say for it how MuJoCo draws; what later tests start must not inherit that."""
    if (said := os.environ.get("MUJOCO_GL")) is None:
        monkeypatch.setenv("MUJOCO_GL", "")
        monkeypatch.delenv("MUJOCO_GL")
    else:
        monkeypatch.setenv("MUJOCO_GL", said)


# Started in the background of a shell Ctrl-C is ignored, and under nohup SIGHUP, here and in all that is started from
# here; tests send both.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

# A slow or busy machine is no failure, and the same examples come each time. To search for new ones:
# pytest --hypothesis-profile=search
settings.register_profile("same", deadline=None, max_examples=40, derandomize=True)
settings.register_profile("short", deadline=None, max_examples=15, derandomize=True)
settings.register_profile("search", deadline=None, max_examples=2000, print_blob=True)
settings.load_profile("same")


def is_short(config: pytest.Config) -> bool:
    """Whether the long tests are left out, as by `make test`: then the others draw less, too."""
    return str(config.option.markexpr) == "not long"


def pytest_configure(config: pytest.Config) -> None:
    """Draw fewer examples where the long tests are left out, unless a profile is asked for."""
    if is_short(config) and not config.getoption("--hypothesis-profile"):
        settings.load_profile("short")


@pytest.fixture(scope="session")
def share(request):
    """Of what a test draws by itself: a quarter where the long tests are left out, else all."""
    return 0.25 if is_short(request.config) else 1.0


@contextmanager
def unheard() -> Iterator[None]:
    """Both streams of this process go nowhere: native libraries print."""
    kept = [os.dup(number) for number in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in (1, 2):
            os.dup2(nowhere, number)
        yield
    finally:
        for number, stream in zip((1, 2), kept, strict=True):
            os.dup2(stream, number)
        for stream in (*kept, nowhere):
            os.close(stream)


def read_here(
    function: str, path: Any, error: type[Exception], what: str, memory: float, seconds: float
) -> dict[str, np.ndarray]:
    """Stands for `confined`: reads a file in this process, without limits."""
    module, _, name = function.partition(":")
    try:
        with unheard(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            arrays = getattr(import_module(module), name)(Path(path).absolute())
    except Exception as found:
        reason = one_line(f"{type(found).__name__}: {one_line(found)}")[:160]
        raise error(f"{path}: not {what} that can be read ({reason})") from None
    return {key: np.asarray(array) for key, array in arrays.items()}


@pytest.fixture(autouse=True)
def _read_in_this_process(request, monkeypatch):
    """Where the long tests are left out, libraries read files in this process, but where the mark `apart` stands.

    Starting a process takes half a second with ezc3d or MuJoCo, and four with OpenCascade.
    """
    if is_short(request.config) and request.node.get_closest_marker("apart") is None:
        monkeypatch.setattr("plantar.common.files.gate.confined", read_here)


@pytest.fixture
def within():
    """A limit of memory and time: `with within(megabytes=300, seconds=5.0): ...`.

    The memory is what the process comes to hold beyond what it held before; the time is the processor's. Whoever asks
    for gigabytes gets a MemoryError.
    """
    if not Path("/proc/self/clear_refs").exists():
        pytest.skip("the memory that a process has held is known on Linux only")
    import resource

    def held(what: str) -> float:
        status = Path("/proc/self/status").read_text()
        return float(re.search(rf"{what}:\s*(\d+) kB", status)[1]) / 1e3

    @contextmanager
    def limit(megabytes: float = 400.0, seconds: float = 5.0) -> Iterator[None]:
        Path("/proc/self/clear_refs").write_text("5")  # the peak begins anew
        before, start = held("VmRSS"), time.process_time()
        soft, hard = resource.getrlimit(resource.RLIMIT_AS)
        resource.setrlimit(resource.RLIMIT_AS, (int((held("VmSize") + 4000) * 1e6), hard))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        assert time.process_time() - start < seconds
        assert held("VmHWM") - before < megabytes

    return limit


@pytest.fixture
def quick_figures(request, monkeypatch):
    """Figures of an analysis are drawn once, without their axes being placed; an SVG is an empty one.

    They take nine tenths of an analysis; that they look right is asked where the mark `drawn` stands.
    """
    if request.node.get_closest_marker("drawn"):
        return

    def save(figure, path):
        if path.suffix == ".svg":
            path.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>')
        else:
            figure.set_layout_engine(None)
            save_figure(figure, path)
        return path

    monkeypatch.setattr("plantar.gait.analysis.pages.figure_files.save_figure", save)


@pytest.fixture(scope="session")
def repository():
    """Root folder of the project."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def real_data():
    """Folder with real recordings, feet and robots, from PLANTAR_REAL_DATA; the test is skipped where it is not set."""
    folder = os.environ.get("PLANTAR_REAL_DATA")
    if not folder:
        pytest.skip("PLANTAR_REAL_DATA is not set: no real data to test on")
    assert Path(folder).is_dir(), f"PLANTAR_REAL_DATA is {folder}, which is no folder"
    return Path(folder)


@pytest.fixture(scope="session")
def sole():
    """A foot-shaped sole: a rounded outline of 240 x 100 mm with a waist, its cells clipped."""
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    x = 0.12 * np.cos(angle)
    y = 0.05 * np.sin(angle) * (1.0 - 0.25 * np.exp(-((x / 0.04) ** 2)))
    return hex_layout(np.column_stack([x, y]), name="test sole", cell_area=200e-6)
