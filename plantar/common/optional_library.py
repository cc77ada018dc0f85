"""Imports of optional libraries: missing, broken or interrupted."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import FrameType

from plantar.errors import DependencyError

LIBRARIES: dict[str, dict[str, str]] = {
    "": {
        "numpy": "numpy",
        "scipy": "scipy",
        "shapely": "shapely",
        "typer": "typer",
        "rich": "rich",
        "mcap": "mcap",
        "matplotlib": "matplotlib",
        "msgspec": "msgspec",
        "protobuf": "google.protobuf",
        "xlrd": "xlrd",
    },
    "shoes": {
        "cadquery": "cadquery",
        "ezdxf": "ezdxf",
        "fonttools": "fontTools",
        "pycollada": "collada",
        "trimesh": "trimesh",
    },
    "sim": {
        "mujoco": "mujoco",
        "opencv-contrib-python-headless": "cv2",
        "daqp": "daqp",
        "pycollada": "collada",
        "trimesh": "trimesh",
    },
    "formats": {"rosbags": "rosbags", "ezc3d": "ezc3d", "opencv-contrib-python-headless": "cv2"},
    "study": {"statsmodels": "statsmodels", "XlsxWriter": "xlsxwriter"},
    "parquet": {"pyarrow": "pyarrow"},
    "cluster": {"distributed": "distributed"},
    "gym": {"gymnasium": "gymnasium"},
    "warp": {"mujoco-warp": "mujoco_warp", "warp-lang": "warp"},
}
"""Distribution and module of the libraries that each extra brings; those without an extra are always needed."""

_INTERRUPTS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def optional_library(library: str, extra: str) -> Iterator[None]:
    """Guard the import of an optional library; only imports belong into the block.

    Only that very module's absence is "not installed". Ctrl-C waits until it is loaded.

    Yields None.

    Example:
        >>> with optional_library("no_such_library", "shoes"):
        ...     import no_such_library  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        plantar.errors.DependencyError: no_such_library is not installed; install it with: ...pip install 'cadquery>=...
    """
    with _interrupts_held_back():
        try:
            yield
        except ModuleNotFoundError as error:
            reason = None if error.name == library else str(error)
            raise DependencyError(library, extra, reason) from None
        except Exception as error:  # while loading, a library that is broken raises any error
            raise DependencyError(library, extra, f"{type(error).__name__}: {error}") from None


def need_libraries(extra: str, *libraries: str) -> None:
    """Raise an error unless all can be loaded. `libraries`: names of modules as they are imported.

    Example:
        >>> need_libraries("sim", "json", "no_such_library")  # doctest: +ELLIPSIS
        Traceback (most recent call last):
        plantar.errors.DependencyError: no_such_library is not installed; install it with: ...pip install 'mujoco>=...
    """
    for library in libraries:
        with optional_library(library, extra):
            import_module(library)


@contextmanager
def missing_libraries(extra: str = "") -> Iterator[None]:
    """Turn the absence of any library of an extra, wherever below the block it is imported, into a `DependencyError`.

    For doors, whose rooms import what they need. `extra`: the one to name where several bring the library. Other errors
    pass. A decorator, too. Yields None.

    Example:
        >>> with missing_libraries("sim"):  # doctest: +ELLIPSIS
        ...     raise ModuleNotFoundError("No module named 'daqp'", name="daqp")
        Traceback (most recent call last):
        plantar.errors.DependencyError: daqp is not installed; install it with: ...pip install 'mujoco>=...
    """
    try:
        yield
    except ModuleNotFoundError as error:
        library = (error.name or "").partition(".")[0]
        bringing = [name for name, modules in LIBRARIES.items() if library in modules.values()]
        if not bringing:
            raise
        raise DependencyError(library, extra if extra in bringing else bringing[0]) from None


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Deliver a signal after the block; a second one of its kind at once."""
    if threading.current_thread() is not threading.main_thread():  # signals reach the main thread only
        yield
        return
    before = {n: h for n in _INTERRUPTS if callable(h := signal.getsignal(n))}
    came: list[int] = []

    def hold_back(number: int, frame: FrameType | None) -> None:
        came.append(number)
        if came.count(number) > 1:
            before[signal.Signals(number)](number, frame)

    for number in before:
        signal.signal(number, hold_back)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            before[signal.Signals(came[0])](came[0], None)
