"""Files and folders that appear whole or not at all: write under a temporary name, then rename."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from plantar.errors import InputError

__all__ = ["output_folder", "replacing", "write_text"]


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside `path`; on success it takes the name `path`, on an error it is deleted.

    Args:
        path: The final path; the temporary one keeps its suffix.

    Yields:
        The temporary path to write to.

    Raises:
        InputError: If the folder does not exist or cannot be written to.
    """
    final = Path(path)
    try:
        handle, name = tempfile.mkstemp(prefix=f".{final.stem}.", suffix=final.suffix, dir=final.parent)
    except OSError as error:
        raise InputError(
            f"cannot write {final}: {error.strerror}; choose a folder that exists and is writable"
        ) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)
        os.replace(temporary, final)
    except OSError as error:
        raise InputError(f"cannot write {final}: {error.strerror}") from None
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: str | os.PathLike[str], text: str) -> Path:
    """Write a text file (UTF-8) that appears whole or not at all; returns the path."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return Path(path)


@contextmanager
def output_folder(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary folder; on success its files move into `path` (made if needed), on an error nothing is left.

    Files of `path` that the run does not write stay as they are.

    Args:
        path: The output folder, which may exist.

    Yields:
        The temporary folder to write to.

    Raises:
        InputError: If the folder cannot be made or written to.
    """
    final = Path(path)
    made: list[Path] = []
    done = False
    try:
        if final.exists() and not final.is_dir():
            raise InputError(f"output folder {final} is a file; choose another name")
        made = [p for p in (final, *final.parents) if not p.exists()]
        final.mkdir(parents=True, exist_ok=True)
        temporary = Path(tempfile.mkdtemp(prefix=".plantar-", dir=final))
    except OSError as error:
        _remove_empty(made)
        raise InputError(f"output folder {final} cannot be written to ({error.strerror}); choose one with -o") from None
    try:
        yield temporary
        moves = [(p, final / p.relative_to(temporary)) for p in sorted(temporary.rglob("*")) if p.is_file()]
        for _, target in moves:  # before the first move, so that all files appear or none
            if target.is_dir():
                raise InputError(f"cannot write {target}: a folder of this name is in the way; choose another with -o")
        try:
            for source, target in moves:
                target.parent.mkdir(parents=True, exist_ok=True)
                os.replace(source, target)
        except OSError as error:
            raise InputError(f"output folder {final} cannot be written to ({error.strerror})") from None
        done = True
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        if not done:
            _remove_empty(made)


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
