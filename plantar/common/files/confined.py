"""Native code on a foreign file, in a separate process with limits."""

import io
import os
import signal
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.console.ending import one_line
from plantar.errors import PlantarError

_CODE = "from plantar.common.files.confined import _called_on_file; _called_on_file()"
_LARGEST_FILE = 1_000_000_000  # bytes that the process may write of a temporary file
_WAITED = 20.0  # times the processor time that is allowed: a busy machine gives a process a small share of it
_STARTING = 60.0  # s that starting the process may take on a busy machine


def confined(
    function: str, path: str | os.PathLike[str], error: type[PlantarError], what: str, memory: float, seconds: float
) -> dict[str, NDArray[Any]]:
    """Returns arrays of a `function`, "package.module:name", called on `path` in a separate process.

    It takes the path and returns arrays by name. Raises `error` if it raises, crashes or passes a limit: `memory` in
    bytes, processor time `seconds`; what takes none is waited for a multiple of that, however busy the machine; `what`
    is the expected file, such as "a C3D file".

    Example:
        >>> confined("os.path:getsize", "none", PlantarError, "a file", memory=1e9, seconds=10.0)
        Traceback (most recent call last):
        plantar.errors.PlantarError: none: not a file that can be read (FileNotFoundError: [Errno 2] No such file ...)
    """
    with TemporaryDirectory(prefix="plantar-") as folder:
        limits = [str(int(limit)) for limit in (memory, seconds + 1.0, _LARGEST_FILE)]
        arguments = [function, os.path.abspath(path), *limits]
        try:
            done = subprocess.run(
                [sys.executable, "-P", "-c", _CODE, *arguments],
                capture_output=True,
                stdin=subprocess.DEVNULL,
                env=_environment(folder),
                timeout=_WAITED * seconds + _STARTING,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise error(f"{path}: not {what} that can be read (it takes longer than {seconds:.0f} s)") from None
    try:
        with np.load(io.BytesIO(done.stdout), allow_pickle=False) as held:
            return {name: held[name] for name in held.files}
    except (ValueError, OSError, EOFError, KeyError):
        raise error(f"{path}: not {what} that can be read ({_reason(done, memory, seconds)})") from None


def _environment(folder: str) -> dict[str, str]:
    """One thread, a folder for temporary files, no modules from the current folder."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    places = [place for place in os.environ.get("PYTHONPATH", "").split(os.pathsep) if place]
    return {**os.environ, **threads, "TMPDIR": folder, "PYTHONPATH": os.pathsep.join(places)}


def _reason(done: subprocess.CompletedProcess[bytes], memory: float, seconds: float) -> str:
    if done.returncode < 0:
        name = signal.Signals(-done.returncode).name
        return f"it takes longer than {seconds:.0f} s" if name == "SIGXCPU" else f"the library ended with {name}"
    lines = done.stderr.decode(errors="replace").strip().splitlines()
    last = one_line(lines[-1])[:160] if lines else f"the library ended with {done.returncode}"
    if "MemoryError" in last or "bad_alloc" in last:
        return f"it asks for more than {memory / 1e6:.0f} MB of memory"
    return last


def _called_on_file() -> None:
    """In the separate process: call the named function, write its result to stdout."""
    function, path, *limits = sys.argv[1:]
    output = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # libraries may print
    module, _, name = function.partition(":")
    call = getattr(import_module(module), name)
    _limit(*map(int, limits))
    try:
        arrays = call(Path(path))
    except Exception as error:  # of every kind: one line of it is given
        print(f"{type(error).__name__}: {one_line(error)}", file=sys.stderr)
        sys.exit(1)
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    with os.fdopen(output, "wb") as stream:
        stream.write(buffer.getvalue())


def _limit(memory: int, seconds: int, largest_file: int) -> None:
    try:
        import resource
    except ImportError:  # no such limits on this system: the time limit of who waits remains
        return
    for what, limit in (
        (resource.RLIMIT_DATA, memory),
        (resource.RLIMIT_CPU, seconds),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_FSIZE, largest_file),
    ):
        try:
            resource.setrlimit(what, (limit, limit + 2 if what == resource.RLIMIT_CPU else limit))
        except (ValueError, OSError):  # not settable here
            continue
