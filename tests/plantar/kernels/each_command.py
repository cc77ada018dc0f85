"""Runs commands of the package in the working folder: a line of JSON in, the words, and one out, what they did.

What the commands load of others, given as arguments, is loaded once, and each command is a process forked from that:
all kernels times all commands would take hours otherwise.
"""

import contextlib
import json
import os
import sys
import tempfile
import traceback
from importlib import import_module
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import Any


def run_forked(words: list[str]) -> dict[str, Any]:
    """Exit code, output and errors of `plantar WORDS`, and the package's extensions that it loaded."""
    with tempfile.TemporaryDirectory() as folder:
        out, error, loaded = (Path(folder, name) for name in ("out", "error", "loaded"))
        child = os.fork()
        if child == 0:
            os._exit(_run(words, out, error, loaded))
        _, status = os.waitpid(child, 0)
        return {
            "code": os.waitstatus_to_exitcode(status),
            "out": out.read_text(),
            "error": error.read_text(),
            "loaded": loaded.read_text().split(),
        }


def _run(words: list[str], out: Path, error: Path, loaded: Path) -> int:
    """Run the command in this process, its streams and its extensions' names in files, and return its exit code."""
    with out.open("w") as stdout, error.open("w") as stderr:
        os.dup2(stdout.fileno(), 1)
        os.dup2(stderr.fileno(), 2)
    sys.argv = ["plantar", *words]
    code = 0
    try:
        import_module("plantar.__main__").main()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        code = 99
    sys.stdout.flush()
    sys.stderr.flush()
    loaded.write_text("\n".join(_extensions()))
    return code


def _extensions() -> list[str]:
    """Names of the package's extensions that this process has loaded."""
    files = {name: getattr(module, "__file__", None) or "" for name, module in sys.modules.items()}
    return [n for n, file in files.items() if n.startswith("plantar.") and file.endswith(tuple(EXTENSION_SUFFIXES))]


if __name__ == "__main__":
    for name in sys.argv[1:]:
        with contextlib.suppress(Exception):
            import_module(name)
    sys.path.insert(0, str(Path.cwd()))
    assert not any(name.startswith("plantar") for name in sys.modules)
    for line in sys.stdin:
        print(json.dumps(run_forked(json.loads(line))), flush=True)
