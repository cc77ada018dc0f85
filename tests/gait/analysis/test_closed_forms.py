"""Measures against closed forms: an elliptic contact that rolls over a fine mat, and prints of known shape."""

import math
from pathlib import Path

import numpy as np
import pytest

from plantar.formats.recorded_layouts import grid_cells
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_pixels
from plantar.gait.analysis.prints.platform import separated_feet
from plantar.gait.analysis.prints.regions import REGIONS, regions_of, with_toe_line
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.steps.step_measures import force_measures
from plantar.layouts.layout import Side
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

A, B = 0.05, 0.03
"""Half axes of the ellipse along and across the foot in m."""

FROM, TO = 0.07, 0.19
PRESSURE = 200e3
STANCE = 0.8
PITCH = 0.002
AREA = math.pi * A * B


def rolling_ellipse(kind="insole", rate=200.0, turn=0.0, side="left"):
    """An ellipse of even pressure whose middle moves along x from FROM to TO at even speed, three times."""
    rows, columns = 130, 60
    layout = grid_cells(np.ones((rows, columns), dtype=bool), PITCH, PITCH, side="left", name="mat", threshold=1e3)
    time = np.arange(0.0, 3.9, 1.0 / rate)
    phase = (time % 1.3 - 0.25) / STANCE
    x, y = layout.positions[:, 0], layout.positions[:, 1]
    force = np.zeros((len(time), len(layout)))
    for i in np.flatnonzero((phase >= 0.0) & (phase <= 1.0)):
        middle = FROM + phase[i] * (TO - FROM)
        along = (x - middle) * math.cos(turn) + y * math.sin(turn)
        across = -(x - middle) * math.sin(turn) + y * math.cos(turn)
        force[i] = PRESSURE * layout.areas * ((along / A) ** 2 + (across / B) ** 2 <= 1.0)
    return PressureRecording(
        Path("x"),
        "synthetic",
        rate,
        time,
        {side: FootRecording(side, force, layout)},
        kind=kind,
        metadata={"side": side},
    )


def gait_of(recording: PressureRecording) -> FootGait:
    recording, prints = separated_feet(recording)
    (gait,) = analyse_feet(recording, prints).values()
    return gait


@pytest.mark.parametrize("kind", ["insole", "platform"])
def test_a_rolling_ellipse_has_the_measures_of_its_formulas(kind):
    gait = gait_of(rolling_ellipse(kind))
    assert len(gait.steps) == 3
    for step in gait.steps:
        speed = (TO - FROM) / STANCE
        assert step["contact_time_s"] == pytest.approx(STANCE, abs=0.006)
        assert step["peak_force_N"] == pytest.approx(PRESSURE * AREA, rel=0.01)
        assert step["impulse_Ns"] == pytest.approx(PRESSURE * AREA * STANCE, rel=0.01)
        assert step["mean_force_N"] == pytest.approx(PRESSURE * AREA, rel=0.01)
        assert step["peak_pressure_Pa"] == pytest.approx(PRESSURE)
        assert step["mean_pressure_Pa"] == pytest.approx(PRESSURE)
        assert step["contact_area_m2"] == pytest.approx(AREA, rel=0.01)
        assert step["footprint_area_m2"] == pytest.approx(AREA + 2 * B * (TO - FROM), rel=0.01)
        # each frame's largest pressure is the same; a cell on the way carries it while the ellipse passes
        assert step["pressure_time_integral_Pas"] == pytest.approx(PRESSURE * STANCE, rel=0.01)
        assert step["pressure_time_integral_cell_Pas"] == pytest.approx(PRESSURE * 2 * A / speed, rel=0.02)
        assert step["cop_path_m"] == pytest.approx(TO - FROM, rel=0.01)
        assert step["cop_excursion_ap_m"] == pytest.approx(TO - FROM, rel=0.01)
        assert step["cop_excursion_ml_m"] < 1e-6
        assert step["cop_velocity_m_s"] == pytest.approx(speed, rel=0.01)
        assert step["support_polygon_area_m2"] == pytest.approx(AREA, rel=0.05)
    path = gait.cop[gait.contacts[1].begin : gait.contacts[1].end]
    straight = np.linspace(FROM, TO, len(path))
    assert np.nanmax(np.abs(path[2:-2, 0] - straight[2:-2])) < PITCH


def stadium_arch_index() -> float:
    """Middle third of the strip that the ellipse sweeps, over all of it."""
    length = TO - FROM + 2 * A

    def area(u: float) -> float:  # of the strip from its back to u
        if u <= A:
            return AREA / 2 - A * B * (math.asin((A - u) / A) + (A - u) / A * math.sqrt(1 - ((A - u) / A) ** 2))
        if u <= length - A:
            return AREA / 2 + 2 * B * (u - A)
        return AREA + 2 * B * (TO - FROM) - area(length - u)

    return (area(2 * length / 3) - area(length / 3)) / area(length)


def test_the_arch_index_of_the_swept_strip():
    gait = gait_of(rolling_ellipse())
    assert gait.footprint is not None
    assert gait.footprint.toe_line is None  # nothing tells toes: the index is that of the whole print
    assert gait.footprint.arch_index() == pytest.approx(stadium_arch_index(), rel=0.01)
    assert gait.footprint.length == pytest.approx(TO - FROM + 2 * A, abs=2 * PITCH)
    assert gait.footprint.width == pytest.approx(2 * B, abs=2 * PITCH)


def ellipse_print(a: float, b: float, turn: float, pitch: float = 0.001, side: Side = "left") -> Footprint:
    x, y = np.meshgrid(np.arange(-0.16, 0.16, pitch), np.arange(-0.16, 0.16, pitch))
    along, across = x * math.cos(turn) + y * math.sin(turn), -x * math.sin(turn) + y * math.cos(turn)
    inside = (along / a) ** 2 + (across / b) ** 2 <= 1.0
    forward = np.array([math.cos(turn + 0.15), math.sin(turn + 0.15)])
    return footprint_of_pixels(np.column_stack([x[inside], y[inside]]), pitch, side, forward)


@pytest.mark.parametrize("turn", [0.0, 0.3, -1.2, 2.5])
@pytest.mark.parametrize("side", ["left", "right"])
def test_an_ellipse_has_its_arch_index_axis_and_size_at_any_angle(turn, side):
    print_ = ellipse_print(0.12, 0.045, turn, side=side)
    third = (2 / math.pi) * (math.asin(1 / 3) + math.sqrt(8) / 9)  # middle third of an ellipse: 0.4126
    assert print_.arch_index() == pytest.approx(third, rel=0.01)
    assert print_.length == pytest.approx(0.24, rel=0.01)
    assert print_.width == pytest.approx(0.09, rel=0.02)
    assert print_.areas.sum() == pytest.approx(math.pi * 0.12 * 0.045, rel=0.01)
    assert print_.axis == pytest.approx([math.cos(turn), math.sin(turn)], abs=0.02)
    assert print_.width_at(0.12) == pytest.approx(0.09, rel=0.02)
    assert print_.width_at(0.5) == 0.0


def foot_print(side: Side) -> Footprint:
    """A drawn foot: heel, a midfoot on the lateral side, ball, a hallux and toes apart from it by a gap."""
    pitch = 0.001
    x, y = np.meshgrid(np.arange(0.0, 0.26, pitch), np.arange(-0.06, 0.06, pitch))
    medial = y if side == "right" else -y

    def disc(u: float, v: float, a: float, b: float) -> np.ndarray:
        return ((x - u) / a) ** 2 + ((medial - v) / b) ** 2 <= 1.0

    inside = disc(0.035, 0.0, 0.035, 0.026) | ((x > 0.03) & (x < 0.16) & (medial > -0.030) & (medial < 0.0))
    inside |= disc(0.155, 0.0, 0.035, 0.045) | disc(0.225, 0.022, 0.02, 0.012) | disc(0.215, -0.015, 0.012, 0.02)
    centres = np.column_stack([x[inside], y[inside]])
    return footprint_of_pixels(centres, pitch, side, np.array([1.0, 0.0]))


@pytest.mark.parametrize("side", ["left", "right"])
def test_toes_and_regions_of_a_drawn_foot(side):
    print_ = with_toe_line(foot_print(side))
    assert print_.toe_line is not None
    assert 0.188 < print_.toeless_length < 0.195
    u, v = print_.centres.T
    names = np.array(list(REGIONS))[regions_of(print_)]
    assert set(names) == set(REGIONS)
    assert u[names == "heel"].max() < 0.07
    assert u[names == "hallux"].min() > 0.19
    assert v[names == "hallux"].mean() > 0.01 > v[names == "toes"].mean()  # v runs to the medial side
    assert v[names == "forefoot_medial"].mean() > v[names == "forefoot_central"].mean()
    assert v[names == "forefoot_central"].mean() > v[names == "forefoot_lateral"].mean()
    thirds = [print_.area_between(i * print_.toeless_length / 3, (i + 1) * print_.toeless_length / 3) for i in range(3)]
    assert sum(thirds) == pytest.approx(print_.areas[~print_.is_toe].sum(), rel=1e-9)
    assert print_.arch_index() == pytest.approx(thirds[1] / sum(thirds))
    assert 0.15 < print_.arch_index() < 0.35


def test_cpei_of_a_bowed_path():
    from plantar.gait.analysis.steps.cop_path import excursion_index

    for side, outward in (("left", 1.0), ("right", -1.0)):
        print_ = ellipse_print(0.12, 0.045, 0.0, side=side)
        share = np.linspace(0.0, 1.0, 201)
        x = -0.10 + 0.20 * share
        bow = 0.01 * np.sin(np.pi * share) * outward  # to the lateral side, which is the left of a left foot
        at = -0.12 + 0.24 * 2 / 3
        expected = 100 * 0.01 * math.sin(math.pi * (at + 0.10) / 0.20) / print_.width_at(0.16)
        assert excursion_index(print_, np.column_stack([x, bow])) == pytest.approx(expected, rel=0.01)
        assert excursion_index(print_, np.column_stack([x, -bow])) == pytest.approx(-expected, rel=0.01)
        assert excursion_index(print_, np.column_stack([x, 0 * bow])) == pytest.approx(0.0, abs=0.05)
        assert math.isnan(excursion_index(print_, np.column_stack([x[:80], bow[:80]])))


def test_force_curve_of_a_trapezoid_and_of_two_humps():
    time = np.linspace(0.0, 1.0, 1001)
    ramp = np.minimum(np.minimum(time / 0.2, 1.0), (1.0 - time) / 0.2) * 500.0
    got = force_measures(time, ramp, 0.0, 1.0)
    assert got["impulse_Ns"] == pytest.approx(500.0 * 0.8, rel=1e-3)
    assert got["loading_rate_N_s"] == pytest.approx(2500.0, rel=0.01)
    assert got["loading_rate_max_N_s"] == pytest.approx(2500.0, rel=0.01)
    assert math.isnan(got["first_peak_N"])  # one plateau is not two peaks
    humps = 600.0 * np.sin(np.pi * time) + 300.0 * np.sin(3 * np.pi * time)
    got = force_measures(time, humps, 0.0, 1.0)
    assert got["first_peak_N"] == pytest.approx(got["second_peak_N"], rel=1e-6)
    assert got["first_peak_N"] == pytest.approx(float(humps.max()))
    assert got["valley_N"] == pytest.approx(300.0)
    assert got["valley_percent"] == pytest.approx(50.0, abs=0.2)
    assert got["impulse_Ns"] == pytest.approx((600.0 + 100.0) * 2 / np.pi, rel=1e-3)


@pytest.mark.parametrize("noise", [0.0, 3.0])
@pytest.mark.parametrize("later", [0.9, 1.0, 1.03])
def test_a_later_hump_of_slow_gait_is_not_the_first_peak(later, noise):
    """Loading to 700 N at 20 % of the stance, a hump in mid-stance that may be higher, push-off at 80 %."""
    time = np.linspace(0.0, 1.2, 121)
    places = [0.0, 0.03, 0.05, 0.2, 0.32, 0.44, 0.6, 0.8, 1.0]
    heights = [0.0, 400.0, 330.0, 700.0, 600.0, 700.0 * later, 560.0, 760.0, 0.0]
    force = np.interp(time / 1.2, places, heights)
    force += np.random.default_rng(1).normal(0.0, noise, len(time)) if noise else 0.0
    measures = force_measures(time, force, 0.0, 1.2)
    assert measures["first_peak_percent"] == pytest.approx(20.0, abs=1.5)
    assert measures["first_peak_N"] == pytest.approx(700.0, rel=0.015)
    assert measures["second_peak_percent"] == pytest.approx(80.0, abs=1.5)
    at = [0.2 * 0.24, 0.8 * 0.24]
    low, high = np.interp(at, 1.2 * np.array(places), heights)
    assert measures["loading_rate_N_s"] == pytest.approx((high - low) / (at[1] - at[0]), rel=0.05)


@pytest.mark.parametrize("shoulder", [0.78, 0.85, 0.92])
def test_a_shoulder_of_the_loading_is_not_the_first_peak(shoulder: float) -> None:
    """A slow step whose force pauses at a share of its first peak, 800 N; mirrored, of its second."""
    time = np.linspace(0.0, 1.2, 121)
    places = [0.0, 0.1, 0.14, 0.28, 0.5, 0.78, 1.0]
    heights = [0.0, 800.0 * shoulder, 775.0 * shoulder, 800.0, 650.0, 820.0, 0.0]
    force = np.interp(time / 1.2, places, heights)
    measures = force_measures(time, force, 0.0, 1.2)
    assert measures["first_peak_percent"] == pytest.approx(28.0, abs=1.5)
    assert measures["first_peak_N"] == pytest.approx(800.0, rel=0.005)
    assert measures["second_peak_N"] == pytest.approx(820.0, rel=0.005)
    back = force_measures(time, force[::-1].copy(), 0.0, 1.2)
    assert back["second_peak_N"] == pytest.approx(800.0, rel=0.005)
