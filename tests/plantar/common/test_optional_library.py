"""An optional library that is missing, one that is broken, and a user who interrupts while it loads are told apart."""

import importlib
import signal
import subprocess
import sys

import pytest

from plantar.common.optional_library import missing_libraries, need_libraries, optional_library
from plantar.errors import DependencyError

INTERRUPTED = """
import os, signal
try:
    os.kill(os.getpid(), signal.SIGINT)
    for _ in range(1000): pass
    {then}
except KeyboardInterrupt:
    raise ImportError("interrupted in the middle")
"""


@pytest.fixture
def load(tmp_path, monkeypatch):
    """Loads a module "frail" of some source under the guard."""
    monkeypatch.syspath_prepend(tmp_path)

    def loaded(source: str) -> None:
        (tmp_path / "frail.py").write_text(source)
        importlib.invalidate_caches()
        monkeypatch.delitem(sys.modules, "frail", raising=False)
        try:
            with optional_library("frail", "shoes"):
                importlib.import_module("frail")
        finally:
            monkeypatch.delitem(sys.modules, "frail", raising=False)

    return loaded


def test_a_library_that_is_not_there_is_not_installed():
    with pytest.raises(DependencyError, match=r"frail is not installed; install it with: .*pip install 'mujoco>="):  # noqa: SIM117
        with optional_library("frail", "sim"):
            importlib.import_module("frail")


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("raise ImportError('libGL.so.1: cannot open shared object file')", "ImportError: libGL.so.1"),
        ("import no_such_part", "No module named 'no_such_part'"),
        ("import numpy.no_such_part", "No module named 'numpy.no_such_part'"),
        ("raise RuntimeError('built for\\nanother numpy')", "RuntimeError: built for another numpy"),
        ("raise OSError('libstdc++ is too old')", "OSError: libstdc"),
    ],
)
def test_a_library_that_is_there_and_broken_says_why(load, source, words):
    with pytest.raises(DependencyError) as caught:
        load(source)
    text = str(caught.value)
    assert "frail is installed but cannot be loaded" in text
    assert words in text
    assert "pip install" not in text
    assert "\n" not in text


@pytest.mark.parametrize("then", ["pass", "raise ImportError('no libGL')"], ids=["loaded", "broken"])
def test_an_interrupt_stays_an_interrupt_and_does_not_meet_the_library(load, then):
    with pytest.raises(KeyboardInterrupt):
        load(INTERRUPTED.format(then=then))
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_who_insists_need_not_wait(load):
    with pytest.raises(KeyboardInterrupt) as caught:
        load(INTERRUPTED.format(then="os.kill(os.getpid(), signal.SIGINT); [0 for _ in range(1000)]"))
    assert "interrupted in the middle" in str(caught.value.__context__)  # what the library made of it


def test_an_interrupt_while_the_cad_kernel_loads_is_no_missing_library():
    """Its native modules turn what interrupts them into import errors, swallow it, or crash."""
    code = (
        "import os, signal, sys, threading, time\n"
        "from plantar.shoes.solid.kernel import load_kernel\n"
        "def interrupt():\n"
        "    time.sleep(0.1); os.kill(os.getpid(), signal.SIGINT)\n"  # it loads for a second
        "threading.Thread(target=interrupt, daemon=True).start()\n"
        "try: load_kernel(); print('loaded')\n"
        "except KeyboardInterrupt: print('interrupted')\n"
    )
    pytest.importorskip("OCP")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=600)
    assert (done.stdout, done.returncode) == ("interrupted\n", 0), done.stdout + done.stderr


def test_the_error_crosses_processes():
    import pickle

    copy = pickle.loads(pickle.dumps(DependencyError("cadquery", "shoes", "no libGL")))
    assert (str(copy), copy.reason) == (str(DependencyError("cadquery", "shoes", "no libGL")), "no libGL")


def test_the_first_library_that_is_missing_is_named(monkeypatch):
    need_libraries("sim", "json", "math")
    monkeypatch.setitem(sys.modules, "json", None)  # as if it were not installed
    with pytest.raises(DependencyError, match=r"json is not installed.*pip install 'mujoco>="):
        need_libraries("sim", "math", "json", "no_such_library")


@pytest.mark.parametrize(
    ("library", "extra", "named"), [("trimesh", "sim", "sim"), ("trimesh", "", "shoes"), ("cv2", "gym", "sim")]
)
def test_a_missing_library_of_an_extra_is_named_with_one_that_brings_it(library, extra, named):
    with pytest.raises(DependencyError) as caught, missing_libraries(extra):
        raise ModuleNotFoundError("No module", name=f"{library}.part")
    assert (caught.value.library, caught.value.extra) == (library, named)


def test_a_missing_module_that_no_extra_brings_stays_what_it_is():
    with pytest.raises(ModuleNotFoundError), missing_libraries("sim"):
        raise ModuleNotFoundError("No module", name="no_such_part")
