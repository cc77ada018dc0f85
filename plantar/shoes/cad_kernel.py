"""OpenCascade, loaded in one place, when a solid is built or a STEP file is read or written."""

from __future__ import annotations

from plantar.optional_library import optional_library

__all__ = ["load_kernel"]


def load_kernel() -> None:
    """Load OpenCascade's Python modules; takes a second.

    Raises:
        DependencyError: If it is not installed or cannot be loaded.
    """
    with optional_library("OCP", "shoes"):
        from OCP.Message import Message, Message_PrinterOStream
    # It prints what it finds wrong in a file to stdout, which belongs to the command; errors are raised anyhow.
    Message.DefaultMessenger_s().RemovePrinters(Message_PrinterOStream.get_type_descriptor_s())
