"""Deletion from a model."""

from collections.abc import Iterable
from typing import Any


def delete_all(spec: Any, elements: Iterable[Any]) -> None:
    """Delete `elements` of `spec`, a `mujoco.MjSpec`."""
    for element in list(elements):
        spec.delete(element)
