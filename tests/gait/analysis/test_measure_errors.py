"""Stated errors against what noise, frames and cells do to made walks whose truth is known."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.formats.nominal_insole import nominal_insole
from plantar.gait.analysis.measure_errors import errors_of_foot
from plantar.gait.analysis.measures import MEASURES
from plantar.gait.analysis.parameters import analyse_feet

from .walks import made_walk

KEYS = ("contact_time_s", "stride_time_s", "peak_force_N", "impulse_Ns", "cop_path_m", "cop_excursion_ap_m")


@pytest.mark.parametrize(("rate", "noise"), [(50.0, 0.3), (100.0, 0.3), (100.0, 1.0)])
def test_errors_are_those_that_noise_makes(rate, noise):
    clean = made_walk(strides=8, rate=400.0)
    noisy = made_walk(strides=8, rate=rate, noise=noise, seed=3)
    true = analyse_feet(clean.recording)["left"]
    found = analyse_feet(noisy.recording)["left"]
    stated = errors_of_foot(noisy.recording, found)
    for key in KEYS:
        off = np.array([step[key] for step in found.steps]) - np.array([step[key] for step in true.steps])
        off = off[np.isfinite(off)]
        actual = float(np.sqrt((off**2).mean()))
        assert actual < 3.0 * stated[key], (key, actual, stated[key])
        assert stated[key] < 0.2 * abs(float(np.nanmean([s[key] for s in found.steps]))), key


def test_every_measure_of_an_insole_has_an_error():
    recording = made_walk(strides=8, noise=0.3).recording
    gait = analyse_feet(recording)["left"]
    stated = errors_of_foot(recording, gait)
    assert set(stated) >= {key for key in gait.columns if key in MEASURES and np.isfinite(gait.columns[key]).any()}
    assert all(0.0 <= error < np.inf for error in stated.values())


def test_coarser_cells_and_frames_err_more():
    def errors(rate: float, size: str) -> dict[str, float]:
        layouts = {side: nominal_insole(size, side) for side in ("left", "right")}
        recording = made_walk(strides=6, rate=rate, noise=0.3, layouts=layouts).recording
        return errors_of_foot(recording, analyse_feet(recording)["left"])

    assert errors(25.0, "u")["contact_time_s"] > errors(200.0, "u")["contact_time_s"]
    assert errors(100.0, "z")["contact_area_m2"] > errors(100.0, "u")["contact_area_m2"]


def test_no_load_has_no_errors():
    recording = made_walk(strides=6).recording
    empty = replace(recording, feet={s: replace(f, force=np.zeros_like(f.force)) for s, f in recording.feet.items()})
    assert errors_of_foot(empty, analyse_feet(empty)["left"]) == {}
