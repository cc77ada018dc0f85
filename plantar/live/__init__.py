"""Readings of soles as they are sampled: `open_live` opens a source, whose `readings` go on after faulty input."""

from plantar.live.arrival import Fault
from plantar.live.checked_stream import CheckedStream, open_live
from plantar.live.sink import LiveSink, open_sink
from plantar.live.source import LiveSource, LiveStream

__all__ = ["CheckedStream", "Fault", "LiveSink", "LiveSource", "LiveStream", "open_live", "open_sink"]
