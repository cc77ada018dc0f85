"""Cells by name, and from TOML files."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from plantar.errors import InputError
from plantar.files.structured_text import packaged_files, read_toml
from plantar.shoes.cells.cell import Cell

__all__ = ["built_in_cells", "read_cell"]

_NAME_MOST = 40  # letters


def built_in_cells() -> dict[str, Path]:
    """Files of the built-in cells by name.

    Example:
        >>> sorted(built_in_cells())
        ['fsr_402', 'fsr_402_long', 'hex', 'sheet', 'square']
    """
    return {path.stem: path for path in packaged_files("plantar.shoes", "cells/*.toml")}


def read_cell(name: str | os.PathLike[str]) -> Cell:
    """A built-in cell by name, or one of a TOML file; without a name it has that of its file.

    Raises:
        InputError: If there is no such cell, the file cannot be read, or a key or value is not allowed.

    Example:
        >>> read_cell("square").kind
        'tile'
    """
    known = built_in_cells()
    path = known.get(str(name), Path(name))
    if path.suffix.lower() != ".toml":
        raise InputError(f"no cell '{name}'; allowed: {', '.join(known)}, or a .toml file that describes one")
    where = f"cell file {path}"
    cell = Cell.from_mapping(read_toml(path, InputError, where), where)
    return cell if cell.name else replace(cell, name=path.stem[:_NAME_MOST])
