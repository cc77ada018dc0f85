"""Opens foreign files: regular and limited in size, or one line why not."""

import hashlib
import os
import stat
from typing import BinaryIO

from plantar.errors import PlantarError

_KINDS = (
    (stat.S_ISDIR, "Is a directory"),
    (stat.S_ISFIFO, "it is a pipe"),
    (stat.S_ISSOCK, "it is a socket"),
    (stat.S_ISCHR, "it is a device"),
    (stat.S_ISBLK, "it is a device"),
)
_NO_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
Name = str | os.PathLike[str]


def is_file(path: Name) -> bool:
    """Whether a regular file has this name; False for impossible names.

    Example:
        >>> is_file("/dev/null"), is_file("x" * 300), is_file("")
        (False, False, False)
    """
    try:
        return stat.S_ISREG(os.stat(path).st_mode)
    except (OSError, ValueError):
        return False


def check_input(path: Name, error: type[PlantarError], most: float | None = None, where: str | None = None) -> int:
    """Returns size in bytes of the file at `path` that a library opens itself.

    Raises `error` if unreadable, no regular file, or larger than `most` bytes; `where` begins the message, else the
    path.

    Example:
        >>> from plantar.errors import FormatError
        >>> check_input("/dev/zero", FormatError)
        Traceback (most recent call last):
        plantar.errors.FormatError: /dev/zero: cannot be read (it is a device); allowed: a regular file
    """
    with open_input(path, error, most, where) as stream:
        return os.fstat(stream.fileno()).st_size


def open_input(path: Name, error: type[PlantarError], most: float | None = None, where: str | None = None) -> BinaryIO:
    """Returns regular file opened for reading; path, error, most and where as of `check_input`.

    Example:
        >>> with open_input(__file__, PlantarError) as stream:
        ...     stream.readline()[3:16]
        b'Opens foreign'
    """
    where = f"{path}:" if where is None else where
    if not os.fspath(path):
        raise error(f"{where} cannot be read (its name is empty)")
    try:
        found = os.stat(path)
        _refuse_others(found.st_mode, error, where)  # before it is opened: even that has effects on a device
        handle = os.open(path, os.O_RDONLY | _NO_WAITING)
        stream = os.fdopen(handle, "rb")
    except OSError as problem:
        raise error(f"{where} cannot be read ({problem.strerror})") from None
    except ValueError as problem:
        raise error(f"{where} cannot be read ({problem})") from None
    try:
        found = os.fstat(handle)
        _refuse_others(found.st_mode, error, where)
        if most is not None and found.st_size > most:
            raise error(f"{where} holds {_size(found.st_size)}; allowed: up to {_size(most)}")
    except PlantarError:
        stream.close()
        raise
    return stream


def is_text(name: str) -> bool:
    """Whether a name holds no bytes that are no UTF-8."""
    return name == name.encode(errors="replace").decode()


def name_in_text(path: Name, error: type[PlantarError], where: str | None = None) -> str:
    """Returns the name of a file for a library that takes no bytes; raises `error` for bytes that are no text.

    Example:
        >>> name_in_text("a b.c3d", PlantarError)
        'a b.c3d'
    """
    name = os.fspath(path)
    text = name if isinstance(name, str) else os.fsdecode(name)
    if not is_text(text):
        where = f"{path}:" if where is None else where
        raise error(f"{where} cannot be opened by a library that takes names in UTF-8 alone; allowed: another name")
    return text


def read_input(path: Name, error: type[PlantarError], most: float, where: str | None = None) -> bytes:
    """Returns all bytes of a regular file; path, error, most and where as of `check_input`.

    Example:
        >>> len(read_input(__file__, PlantarError, most=1e6)) == os.path.getsize(__file__)
        True
    """
    where = f"{path}:" if where is None else where
    with open_input(path, error, most, where) as stream:
        try:
            data = stream.read(int(most) + 1)  # files of /proc state no size, and a file may grow
        except OSError as problem:
            raise error(f"{where} cannot be read ({problem.strerror})") from None
    if len(data) > most:
        raise error(f"{where} holds more than {_size(most)}; allowed: up to {_size(most)}")
    return data


def sha256_of(path: Name, error: type[PlantarError]) -> str:
    """Returns the SHA-256 in hexadecimal of a regular file; path and error as of `check_input`."""
    found = hashlib.sha256()
    with open_input(path, error) as stream:
        while block := stream.read(1 << 20):
            found.update(block)
    return found.hexdigest()


def _refuse_others(mode: int, error: type[PlantarError], where: str) -> None:
    if not stat.S_ISREG(mode):
        kind = next((name for holds, name in _KINDS if holds(mode)), "it is no file")
        raise error(f"{where} cannot be read ({kind}); allowed: a regular file")


def _size(count: float) -> str:
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= factor:
            return f"{count / factor:.3g} {unit}"
    return f"{count:.0f} bytes"
