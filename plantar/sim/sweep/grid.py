"""Values of a setting as texts: split from a list, and in one canonical form (1.0 is 1)."""

from __future__ import annotations

import json
from typing import Any

from plantar.errors import InputError
from plantar.files.structured_text import parse_toml

__all__ = ["canonical", "is_word", "split_values"]

_CLOSING = {"[": "]", "{": "}"}


def split_values(text: str) -> list[str]:
    """The TOML values and bare words of a list, split at commas outside brackets and quotes.

    Raises:
        InputError: If a value is empty, or a bracket or quote is not closed.

    Example:
        >>> split_values("[1, 2], [3, 4]")
        ['[1, 2]', '[3, 4]']
    """
    values, begin, quote, closing = [], 0, "", ""
    i = 0
    while i < len(text):
        sign = text[i]
        if quote:
            if sign == "\\" and quote == '"':
                i += 1  # what it escapes does not end the text
            elif sign == quote:
                quote = ""
        elif closing or not text[begin:i].strip():  # inside of brackets, or at the start of a value
            if sign in "\"'":
                quote = sign
            elif sign in _CLOSING:
                closing = _CLOSING[sign] + closing
            elif closing and sign == closing[0]:
                closing = closing[1:]
        if sign == "," and not quote and not closing:
            values.append(text[begin:i].strip())
            begin = i + 1
        i += 1
    if quote or closing:
        raise InputError(f"values '{text}' do not close a {'quote' if quote else 'bracket'}: {quote or closing[0]}")
    values.append(text[begin:].strip())
    if "" in values:
        raise InputError(f"values '{text}' have an empty one; allowed: a,b,c")
    return values


def is_word(key: str) -> bool:
    """Whether a setting takes its text unchanged: a name or a path."""
    return key in ("robot", "machine", "kind", "terrain.kind")


def canonical(text: str, *, word: bool = False) -> str:
    """Returns the one text for all TOML values or bare words `text` with the same meaning; a `word` only loses its
    quotes.

    Raises:
        InputError: If the text begins like a TOML value and is none, or is not printable.

    Example:
        >>> [canonical(text) for text in ("1.0", "0.10", "[1,2]", "'left'", "left", '"1"')]
        ['1', '0.1', '[1, 2]', 'left', 'left', '"1"']
    """
    text = text.strip()
    if not text.isprintable():
        raise InputError(f"value {text!r} is not of printable characters")
    value = _parsed(text)
    if value is None and text[:1] in tuple("\"'[{"):
        raise InputError(f"value '{text}' is not valid TOML")
    if word:
        return value if isinstance(value, str) else text
    return text if value is None else _written(value, bare=True)


def _parsed(text: str) -> Any:
    try:
        return parse_toml(f"v = {text}")["v"]
    except ValueError:
        return None


def _written(value: Any, bare: bool = False) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))  # wherever a setting takes a number, a whole one means the same as its float
    if isinstance(value, str):
        plain = bare and value == value.strip() != "" and value.isprintable() and _parsed(value) is None
        return value if plain and value[0] not in "\"'[{" else json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{json.dumps(k, ensure_ascii=False)} = {_written(v)}' for k, v in value.items())}}}"
    return str(value)
