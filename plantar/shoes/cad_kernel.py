"""The CAD kernel, cadquery: loaded in one place, when a solid is built or a STEP file is read."""

from __future__ import annotations

from typing import Any

from plantar.optional_library import optional_library

__all__ = ["load_cadquery"]


def load_cadquery() -> Any:
    """The cadquery module; loading it takes seconds.

    Raises:
        DependencyError: If it is not installed or cannot be loaded.
    """
    with optional_library("cadquery", "shoes"):
        import cadquery
        from OCP.Message import Message, Message_PrinterOStream
    # The kernel prints what it finds wrong in a file to stdout, which belongs to the command; errors are raised anyhow.
    Message.DefaultMessenger_s().RemovePrinters(Message_PrinterOStream.get_type_descriptor_s())
    return cadquery
