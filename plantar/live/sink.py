"""Where readings go on to as they come: modules here with a `SINK`, and entry points "plantar.live_sinks"."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from plantar.common.extensions import extensions
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.live.source import device_errors
from plantar.sensing.reading import Reading

Send = Callable[[Side, Reading], object]
"""Receives a side and its reading."""


@dataclass(frozen=True)
class LiveSink:
    """One kind of sink.

    Attributes:
        name: Name on the command line, before a colon and the address.
        title: Few words, for the list.
        open: Opens an address, empty if none is given; returns what receives readings. An InputError if it cannot.
    """

    name: str
    title: str
    open: Callable[[str], Send]


def live_sinks() -> dict[str, LiveSink]:
    """All sinks by name; InputError if an entry point is none.

    Example:
        >>> list(live_sinks())[:1]
        ['udp']
    """
    modules = (import_module(f"plantar.live.{module.name}") for module in iter_modules([str(Path(__file__).parent)]))
    found = {s.name: s for module in modules if isinstance(s := getattr(module, "SINK", None), LiveSink)}
    others = extensions("plantar.live_sinks", LiveSink, tuple(found))
    return {**found, **{name: replace(sink, name=name) for name, sink in others.items()}}


def open_sink(text: str) -> Send:
    """Returns what sends readings to a sink by its `text`, such as "udp:9871"; PlantarError if it cannot be opened."""
    name, _, address = text.partition(":")
    known = live_sinks()
    if name not in known:
        raise InputError(f"unknown live sink {name!r}; allowed: {', '.join(known)}")
    with device_errors(f"live sink {text!r} cannot be opened"):
        return known[name].open(address)
