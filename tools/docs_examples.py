"""For mkdocstrings: docstrings use "Example:", which griffe calls "Examples:"."""

import re
from typing import Any

import griffe


class Examples(griffe.Extension):
    """Lets the examples of docstrings be drawn as code."""

    def on_object(self, *, obj: Any, **_: Any) -> None:
        """Rename the section of one object's docstring."""
        if obj.docstring is not None:
            obj.docstring.value = re.sub(r"^Example:$", "Examples:", obj.docstring.value, flags=re.MULTILINE)
