"""Samples of the skin that no control tick sees: which they are, and that leaving them out changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

from sim.bench.watched_run import WatchedSimulation
from sim.run.scene import load_scene

SHORT = ("steps=0", "walk.start=0.2", "walk.end=0.2", "walk.settle=0")


@pytest.mark.parametrize("delay", [0, 1, 3])
@pytest.mark.parametrize(("rate", "period"), [(250, 0.005), (1000, 0.005), (500, 0.004), (100, 0.005), (125, 0.02)])
def test_a_sample_is_unread_if_no_tick_falls_into_the_time_that_it_stands(delay: int, rate: int, period: float):
    settings = (*SHORT, f"skin_rate={rate}", f"control.period={period}", f"delay_periods={delay}")
    sensors = WatchedSimulation(load_scene("flat", settings, "h1"), 0).sensors
    every, ticks = 1000 // rate, round(1000 * period)
    seen = {0}
    for tick in range(0, 400, ticks):
        seen.add(max(0, (tick // every - delay) * every))  # what a queue of so many samples hands out then
    for step in range(0, 400 - (delay + 1) * every - ticks, every):
        assert sensors.unread(step, ticks) == (step not in seen)


@pytest.mark.parametrize("settings", [("skin_rate=300",), ("plant.hysteresis=0.1",)])
def test_where_it_is_not_known_every_sample_counts(settings: tuple[str, ...]):
    sensors = WatchedSimulation(load_scene("flat", (*SHORT, *settings), "h1"), 0).sensors
    assert not any(sensors.unread(step, 5) for step in range(100))


def test_the_samples_that_are_read_are_the_same_with_and_without_the_others():
    scene = load_scene("flat", (*SHORT, "control.pfc=true", "sensing.delay_periods=1"), "h1")
    every, some = (WatchedSimulation(scene, 1).sensors for _ in range(2))
    data = every._world.data
    for step in range(0, 61, 4):
        for sensors in (every, some):
            sensors._world.data.time = 1e-3 * step
        every.read_skins()
        if some.unread(step, 5):
            some.pass_over_skins()
        else:
            some.read_skins()
    assert data.time == 0.06  # when there is a tick
    for side, reading in every.readings.items():
        assert np.array_equal(reading.force, some.readings[side].force)
        assert np.array_equal(reading.proximity, some.readings[side].proximity)
