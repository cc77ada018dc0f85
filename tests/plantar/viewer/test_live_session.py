"""A stream on its page: what is shown, and what the buttons do to the recording."""

import numpy as np
import pytest

from plantar import InputError, Reading, hex_layout, mirrored
from plantar.formats import read_recording
from plantar.live import CheckedStream, LiveStream
from plantar.viewer.live_session import record_with_page
from plantar.viewer.live_state import LiveState

SOLE = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], side="left")


class Buttons:
    """A page whose buttons are pressed at given numbers of states asked for."""

    def __init__(self, pressed):
        self.pressed = pressed
        self.asked = 0
        self.states = []

    def actions(self):
        self.asked += 1
        return self.pressed.get(self.asked, [])

    def send(self, state):
        self.states.append(state)


def stream_of(count=200, force=3.0):
    readings = (("left", Reading(0.01 * k, np.full(len(SOLE), force))) for k in range(count))
    return CheckedStream(LiveStream({"left": SOLE}, readings, "insole"))


def test_zero_mark_and_record_go_into_the_recording(tmp_path):
    page = Buttons({100: ["zero"], 120: ["mark"], 150: ["record"], 180: ["record"]})
    found = record_with_page(stream_of(), page, tmp_path / "a.mcap")
    recorded = read_recording(tmp_path / "a.mcap").feet["left"].force
    assert found["feet"]["left"]["frames"] == 170
    assert recorded[90] == pytest.approx(3.0)
    assert recorded[110] == pytest.approx(0.0)
    log = page.states[-1]["log"]
    assert [line.split("  ")[1] for line in log] == [
        "recording goes on",
        "recording stopped",
        "mark 1",
        "zero: what the soles read is taken off",
    ]
    assert {"time", "soles", "measures", "log", "status", "recording", "arrived"} == set(page.states[-1])
    with pytest.raises(InputError, match="cannot record 0"):
        record_with_page(stream_of(), page, tmp_path / "b.mcap", 0.0)


def test_each_reading_is_offered_to_the_page_as_it_comes(tmp_path):
    """The right sole's readings follow the left one's by 1 ms: both are in what is shown before the next ones come."""
    soles = {"left": SOLE, "right": mirrored(SOLE)}
    page = Buttons({})
    shown = []

    def arrivals():
        for k in range(50):
            for side, after in (("left", 0.0), ("right", 0.001)):
                yield side, Reading(0.04 * k + after, np.full(len(SOLE), float(k)))
                if len(page.states) == 2 * k + (side == "right") + 1:
                    shown.append(page.states[-1]()["soles"][side]["load"])

    record_with_page(CheckedStream(LiveStream(soles, arrivals(), "insole")), page, tmp_path / "a.mcap")
    assert shown == [float(k) * len(SOLE) for k in range(50) for _ in soles]


def test_measures_are_those_of_the_steps_that_were_whole():
    """Two soles in turn, 0.6 s each of 1.0 s; the left stream begins within a contact, which does not count."""
    right = hex_layout(SOLE.outline * [1.0, -1.0], side="right")
    state = LiveState({"left": SOLE, "right": right})
    for k in range(1200):
        at = 0.01 * k
        for side, shift, most in (("left", 0.3, 700.0), ("right", 0.8, 630.0)):
            u = ((at + shift) % 1.0) / 0.6
            load = most * max(0.0, np.sin(np.pi * u)) ** 0.3 if u < 1.0 else 0.0
            state.take(side, Reading(at, np.full(len(SOLE), load / len(SOLE))))
    rows = {row[0]: row[1:] for row in state.as_dict()["measures"]}
    assert rows["Steps"] == ["11", "12"]
    assert rows["Contact time"] == ["0.60 s", "0.60 s"]
    assert rows["Peak force"] == ["700 N", "630 N"]
    assert rows["Peak force, symmetry index"][0] == "+10.5 %"
    assert rows["Cadence"][0] == "120 steps/min"
