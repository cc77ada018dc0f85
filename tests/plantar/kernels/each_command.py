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
from pathlib import Path
from typing import Any


def run_forked(words: list[str]) -> dict[str, Any]:
    """Exit code, output and errors of `plantar WORDS`."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder, "out")
        error = Path(folder, "error")
        child = os.fork()
        if child == 0:
            os._exit(_run(words, out, error))
        _, status = os.waitpid(child, 0)
        return {"code": os.waitstatus_to_exitcode(status), "out": out.read_text(), "error": error.read_text()}


def _run(words: list[str], out: Path, error: Path) -> int:
    """Run the command in this process, its streams in files, and return its exit code."""
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
    return code


if __name__ == "__main__":
    for name in sys.argv[1:]:
        with contextlib.suppress(Exception):
            import_module(name)
    sys.path.insert(0, str(Path.cwd()))
    assert not any(name.startswith("plantar") for name in sys.modules)
    for line in sys.stdin:
        print(json.dumps(run_forked(json.loads(line))), flush=True)
