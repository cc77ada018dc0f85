"""Files and folders that appear whole or not at all, written under temporary names.

The next process that writes there removes what a killed one left.
"""

import os
import platform
import re
import shutil
import tempfile
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from plantar.errors import InputError

_LEFTOVER = re.compile(r"\.plantar-([0-9a-f]{8})-([1-9]\d{0,9})-")


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path with the suffix of `path`, renamed to that on success, deleted on an error.

    An InputError if the folder does not exist or cannot be written to.
    """
    final = Path(path)
    temporary = temporary_beside(final)
    try:
        yield temporary
        os.replace(temporary, final)
    except OSError as error:
        raise InputError(f"cannot write {final}: {error.strerror}") from None
    finally:
        temporary.unlink(missing_ok=True)


def temporary_beside(path: str | os.PathLike[str]) -> Path:
    """Empty temporary file next to `path`, with its suffix and a new file's permissions, to rename or remove.

    An InputError if the folder does not exist or cannot be written to.
    """
    final = Path(path)
    try:
        _remove_leftovers(final.parent)
        handle, name = tempfile.mkstemp(prefix=_prefix(), suffix=final.suffix, dir=final.parent)
        os.close(handle)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
    except OSError as error:
        raise InputError(
            f"cannot write {final}: {error.strerror}; choose a folder that exists and is writable"
        ) from None
    return Path(name)


def write_text(path: str | os.PathLike[str], text: str) -> Path:
    """Write a whole text file (UTF-8) or none; returns the path."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", errors="replace")  # names of files may be of any bytes
    return Path(path)


def keep_inputs(path: str | os.PathLike[str], inputs: Iterable[str | os.PathLike[str] | None]) -> None:
    """An InputError if a file at `path` would replace one of `inputs` (files, or None)."""
    if os.path.realpath(path) in {os.path.realpath(source) for source in inputs if source is not None}:
        raise InputError(f"cannot write {path}: it is what this is made of; choose another name or folder")


@contextmanager
def output_folder(path: str | os.PathLike[str], inputs: Iterable[str | os.PathLike[str] | None] = ()) -> Iterator[Path]:
    """Yields a temporary folder, moved into `path` (made if needed) on success, else deleted; other files in `path`
    stay.

    An InputError if the folder cannot be made or written to, or a file would replace one of `inputs` (files, or None).
    """
    final = Path(path)
    inputs = tuple(inputs)
    made: list[Path] = []
    done = False
    try:
        if final.exists() and not final.is_dir():
            raise InputError(f"output folder {final} is a file; choose another name")
        made = [p for p in (final, *final.parents) if not p.exists()]
        final.mkdir(parents=True, exist_ok=True)
        _remove_leftovers(final)
        temporary = Path(tempfile.mkdtemp(prefix=_prefix(), dir=final))
    except OSError as error:
        _remove_empty(made)
        raise InputError(f"output folder {final} cannot be written to ({error.strerror}); choose one with -o") from None
    try:
        yield temporary
        moves = [(p, final / p.relative_to(temporary)) for p in sorted(temporary.rglob("*")) if p.is_file()]
        for _, target in moves:  # before the first move, so that all files appear or none
            if target.is_dir():
                raise InputError(f"cannot write {target}: a folder of this name is in the way; choose another with -o")
            keep_inputs(target, inputs)
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


@contextmanager
def parent_folder(path: str | os.PathLike[str]) -> Iterator[None]:
    """Make a file's folder; on an error remove what was made.

    An InputError if the folder cannot be made, or the path is a folder itself.
    """
    final = Path(path)
    made: list[Path] = []
    try:
        if final.is_dir():
            raise InputError(f"cannot write {final}: it is a folder; give the name of a file")
        made = [p for p in final.parents if not p.exists()]
        final.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        _remove_empty(made)
        raise InputError(f"cannot write {final}: {error.strerror}; choose another folder") from None
    try:
        yield
    except BaseException:
        _remove_empty(made)
        raise


@cache
def _machine() -> str:
    """Distinguishes this machine's or container's process numbers from others'."""
    try:
        space = os.readlink("/proc/self/ns/pid")
    except OSError:
        space = ""
    return f"{zlib.crc32(f'{platform.node()} {space}'.encode()):08x}"


def _prefix() -> str:
    return f".plantar-{_machine()}-{os.getpid()}-"


def _remove_leftovers(folder: Path) -> None:
    """Remove temporary files of this machine's dead processes."""
    if os.name == "nt":  # where no signal asks whether a process lives
        return
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _LEFTOVER.match(entry.name)
            if match is None or match[1] != _machine() or _lives(int(match[2])):
                continue
            if entry.is_dir(follow_symlinks=False):
                shutil.rmtree(entry.path, ignore_errors=True)
            else:
                with suppress(OSError):
                    os.unlink(entry.path)


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):  # somebody else's, or no number of a process
        return True
    return True


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        try:
            folder.rmdir()
        except OSError:
            return
