"""Live sources, which read soles as they are sampled: modules here with a `SOURCE`, and entry points "plantar.live"."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Literal, NamedTuple

from plantar.common.arguments import instance
from plantar.common.extensions import extensions
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.calibration import CountStream
from plantar.layouts.layout import SoleLayout
from plantar.live.arrival import Arrival, Fault
from plantar.recordings.pressure_recording import Kind
from plantar.sensing.reading import Reading

QUIET = 0.5
"""Time in s without a reading after which a source yields None."""


Unit = Literal["N", "counts"]
"""Of a stream's values: forces, or what a converter counts until a calibration makes forces of it."""


class LiveStream(NamedTuple):
    """What arrives of a source.

    Attributes:
        soles: Layout of each side that comes.
        readings: A side and its reading each, as they arrive; in their place a `Fault` for what is no reading, and None
            where nothing comes for half a second. Ends with the device, closed when no longer read.
        kind: What measures: a robot's soles, a person's insoles, or a platform.
        unit: Of the readings' forces.
    """

    soles: Mapping[Side, SoleLayout]
    readings: Iterator[Arrival]
    kind: Kind = "robot"
    unit: Unit = "N"


@dataclass(frozen=True)
class LiveSource:
    """One kind of source.

    Attributes:
        name: Name on the command line, before a colon and the address.
        title: Few words, for the list.
        open: Opens an address, empty if none is given, with a sole layout or None; an InputError if it cannot.
    """

    name: str
    title: str
    open: Callable[[str, SoleLayout | None], LiveStream]


def live_sources() -> dict[str, LiveSource]:
    """All sources by name; InputError if an entry point is none.

    Example:
        >>> list(live_sources())[:6]
        ['file', 'lines', 'packets', 'replay', 'serial', 'udp']
    """
    modules = (import_module(f"plantar.live.{module.name}") for module in iter_modules([str(Path(__file__).parent)]))
    found = {s.name: s for module in modules if isinstance(s := getattr(module, "SOURCE", None), LiveSource)}
    others = extensions("plantar.live", LiveSource, tuple(found))
    return {**found, **{name: replace(source, name=name) for name, source in others.items()}}


def opened_source(text: str, layout: SoleLayout | None) -> LiveStream:
    """Returns what arrives of a source by its `text`, such as "replay:run.mcap", unchecked; its soles have a `layout`,
    mirrored for the other foot, or their own. PlantarError if it is unknown or cannot be opened.
    """
    name, _, address = text.partition(":")
    known = live_sources()
    if name not in known:
        raise InputError(f"unknown live source {name!r}; allowed: {', '.join(known)}")
    with device_errors(f"live source {text!r} cannot be opened"):
        return instance(known[name].open(address, layout), LiveStream, f"stream of live source {name!r}")


def in_newtons(stream: LiveStream) -> LiveStream:
    """A stream whose readings hold counts, with forces by the calibration of its soles; InputError if one has none."""
    streams: dict[Side, CountStream] = {}
    for side, sole in stream.soles.items():
        if sole.calibration is not None:
            streams[side] = CountStream(sole.calibration, sole)
    if not streams:
        raise InputError("the layout holds no calibration; allowed with --counts: one from plantar calibrate")
    soles = {side: sole for side, sole in stream.soles.items() if side in streams}
    return stream._replace(soles=soles, readings=_converted(stream.readings, streams), unit="N")


def _converted(arrivals: Iterator[Arrival], streams: Mapping[Side, CountStream]) -> Iterator[Arrival]:
    for arrival in arrivals:
        if arrival is None or isinstance(arrival, Fault):
            yield arrival
            continue
        side, reading = arrival
        if side not in streams:
            yield Fault("garbled", f"a reading is of the {side} sole, which is not calibrated")
        else:
            yield side, Reading(reading.time, streams[side].force(reading.force, reading.time))


@contextmanager
def device_errors(what: str) -> Iterator[None]:
    """An OSError in its block becomes an InputError that begins with `what`."""
    try:
        yield
    except OSError as error:
        raise InputError(f"{what}: {error.strerror or error}") from None
