"""Reads foreign TOML and JSON, limited in size and depth; errors are one line."""

import json
import os
import re
import tomllib
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from plantar.common.files.input_file import read_input
from plantar.errors import InputError, PlantarError

TOML_MOST = 250_000
"""Largest TOML file in bytes."""

JSON_MOST = 16_000_000
"""Largest JSON file in bytes: a layout of some 25,000 taxels."""

_PART = r"""(?:(?<![A-Za-z0-9_-])[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
# A dotted key of more than ten parts: reading one takes memory by the square of its parts.
_DEEP_KEY = re.compile(rf"(?:{_PART}[ \t]*+\.[ \t]*+){{10}}")


def parse_toml(text: str) -> dict[str, Any]:
    """Table of a TOML text; one-line ValueError if invalid or nested too deep.

    Example:
        >>> parse_toml("a = [1, 2]")
        {'a': [1, 2]}
        >>> parse_toml("a = " + 100_000 * "[")
        Traceback (most recent call last):
        ValueError: nested too deep
    """
    if _DEEP_KEY.search(text):
        raise ValueError("nested too deep")
    try:
        table = tomllib.loads(text)
    except RecursionError:
        raise ValueError("nested too deep") from None
    _refuse_long_integers(table)
    return table


def _refuse_long_integers(value: Any) -> None:
    if isinstance(value, int) and value.bit_length() > 64:
        raise ValueError("it holds an integer of more than 64 bits")
    for inner in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        _refuse_long_integers(inner)


def read_toml(path: str | os.PathLike[str], error: type[PlantarError], where: str) -> dict[str, Any]:
    """Returns table of the TOML file at `path`, UTF-8 with or without a byte order mark, up to TOML_MOST bytes.

    Raises `error` if unreadable or invalid; `where` begins the message, such as "scene file walk.toml".

    Example:
        >>> from plantar.errors import SceneError
        >>> read_toml("none.toml", SceneError, "scene file none.toml")
        Traceback (most recent call last):
        plantar.errors.SceneError: scene file none.toml cannot be read (No such file or directory)
    """
    try:
        return parse_toml(_text(read_input(path, error, TOML_MOST, where)))
    except ValueError as problem:
        raise error(f"{where} is not valid TOML ({problem})") from None


def read_json(path: str | os.PathLike[str], error: type[PlantarError], where: str, kind: str = "valid JSON") -> Any:
    """Returns value of the JSON file at `path`, UTF-8 with or without a byte order mark, up to JSON_MOST bytes.

    Raises `error` if unreadable or not of a `kind`; `where` begins the message, such as "layout file sole.json".

    Example:
        >>> from plantar.errors import LayoutError
        >>> read_json("/dev/null", LayoutError, "layout file /dev/null")
        Traceback (most recent call last):
        plantar.errors.LayoutError: layout file /dev/null cannot be read (it is a device); allowed: a regular file
    """
    try:
        return json.loads(_text(read_input(path, error, JSON_MOST, where)))
    except RecursionError:
        raise error(f"{where} is not {kind} (nested too deep)") from None
    except ValueError as problem:
        raise error(f"{where} is not {kind} ({problem})") from None


def packaged_files(package: str, pattern: str) -> list[Path]:
    """Returns sorted paths of data files by `pattern` below a `package`, which is not loaded; none if not installed.

    Example:
        >>> [path.name for path in packaged_files("plantar.sim", "scenes/beam*.toml")]
        ['beam-forward.toml', 'beam-yaw.toml', 'beam.toml']
        >>> packaged_files("no_such_package", "*")
        []
    """
    spec = find_spec(package)
    folders = (spec.submodule_search_locations or []) if spec else []
    return [path for folder in folders for path in sorted(Path(folder).glob(pattern))]


def described_files(paths: Iterable[Path]) -> dict[Path, str]:
    """First line of each TOML file's "title" or "description" by path, or empty.

    Example:
        >>> [*described_files(packaged_files("plantar.sim", "scenes/beam.toml")).values()][0][:14]
        '50 side steps '
    """
    found = {}
    for path in paths:
        try:
            facts = read_toml(path, InputError, f"file {path}")
        except InputError:
            facts = {}
        text = next((str(facts[k]) for k in ("title", "description", "about") if k in facts), "")
        found[path] = text.strip().split("\n")[0]
    return found


def _text(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as problem:
        raise ValueError(f"not a text file: no UTF-8 at byte {problem.start}") from None
