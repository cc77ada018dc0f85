"""One process at a time in a folder."""

from __future__ import annotations

import os
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from plantar.errors import InputError

__all__ = ["locked"]

_NAME = ".sweep.lock"
_PLACE = 1 << 20  # where Windows locks a byte: behind the owner's name, which stays readable


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of an existing folder; the system releases it however its owner ends.

    Raises:
        InputError: If another process holds it (the message names it), or the file system has no locks.
    """
    path = folder / _NAME
    handle = _acquire(path)
    try:
        os.ftruncate(handle, 0)
        os.write(handle, f"process {os.getpid()} on {socket.gethostname()}".encode())
        yield
    finally:
        with suppress(OSError):  # Windows does not delete what is open
            path.unlink(missing_ok=True)
        os.close(handle)


def _acquire(path: Path) -> int:
    while True:
        handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _lock(handle):
                owner = _owner(handle)
                raise InputError(
                    f"another sweep{owner} writes to {path.parent}; wait for its end or choose another folder with -o"
                )
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(handle), os.stat(path)):
                    return handle
        except BaseException as error:
            os.close(handle)
            if isinstance(error, OSError):
                raise InputError(
                    f"{path.parent} cannot be locked ({error.strerror}); choose a folder on another disk with -o"
                ) from None
            raise
        os.close(handle)  # its owner has just ended and deleted it: the next process makes another one


def _lock(handle: int) -> bool:
    """Lock an open file for this process; False where another has it."""
    if sys.platform == "win32":
        import msvcrt

        os.lseek(handle, _PLACE, os.SEEK_SET)
        try:
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        finally:
            os.lseek(handle, 0, os.SEEK_SET)
        return True
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _owner(handle: int) -> str:
    with suppress(OSError):
        os.lseek(handle, 0, os.SEEK_SET)
        if found := os.read(handle, 200).decode(errors="replace"):
            return f" ({found})"
    return ""
