"""OpenCascade, loaded in one place, when a solid is built or a STEP file is read or written."""

from __future__ import annotations

from functools import cache
from typing import Any

from plantar.optional_library import optional_library

__all__ = ["load_kernel"]


@cache
def load_kernel() -> Any:
    """OpenCascade's module with all of its packages; loading it takes a second.

    Raises:
        DependencyError: If it is not installed or cannot be loaded.
    """
    with optional_library("OCP", "shoes"):
        import OCP
        import OCP.TopoDS  # gives names of the version before
    # It prints what it finds wrong in a file to stdout, which belongs to the command; errors are raised anyhow.
    printers = OCP.Message.Message_PrinterOStream.get_type_descriptor_s()
    OCP.Message.Message.DefaultMessenger_s().RemovePrinters(printers)
    return OCP
