"""What holds of any walk, over made ones of feet and of a robot's soles."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.gait.analysis.analyse import Analysis, analyse
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.study.statistics import student_quantile
from plantar.gait.analysis.summary import spread

from ...fuzz.made_tables import made_table
from .walks import made_walk


@pytest.mark.parametrize("kind", ["insole", "robot"])
@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_physical_bounds(kind, noise):
    recording = replace(made_walk(strides=4, rate=50.0, noise=noise).recording, kind=kind)
    steps = [step for gait in analyse_feet(recording).values() for step in gait.steps]
    assert len(steps) == 8
    for step in steps:
        both = step["double_support_percent"] + step["single_support_percent"]
        if np.isfinite(both):
            assert both == pytest.approx(step["stance_percent"])
            assert step["stance_percent"] + step["swing_percent"] == pytest.approx(100.0)
        area = step["footprint_area_m2"]
        assert step["force_time_integral_area_Pas"] * area == pytest.approx(step["impulse_Ns"])
        assert step["mean_force_N"] * step["contact_time_s"] == pytest.approx(step["impulse_Ns"])
        assert 0.0 < step["mean_pressure_Pa"] <= step["mean_pressure_max_Pa"] <= step["peak_pressure_Pa"]
        assert step["pressure_time_integral_cell_Pas"] <= step["pressure_time_integral_Pas"]
        if kind == "robot":
            assert 0.0 <= step["cop_margin_polygon_m"] <= step["cop_margin_polygon_mean_m"]


def _check_bounds(walk: Analysis) -> int:
    """Bounds of every complete step of a recording, and how many there are."""
    steps = walk.steps
    for row in range(len(steps["side"])):
        step = {key: float(v[row]) for key, v in steps.items() if v.dtype == float}
        both = step["double_support_percent"] + step["single_support_percent"]
        assert np.isnan(both) or both == pytest.approx(step["stance_percent"])
        assert min(step.get("double_support_percent", 0.0) + 1e-9, step["contact_time_s"]) >= 0.0 or np.isnan(both)
        length = step["stride_velocity_m_s"] * step["stride_time_s"]
        assert np.isnan(length) or length == pytest.approx(step["stride_length_m"])
        assert not step["cop_margin_polygon_m"] < 0.0
        assert not step["cop_path_m"] < 0.999 * step["cop_excursion_ap_m"]
        force = "peak_force_raw" if walk.recording.raw else "peak_force_N"
        mean = "mean_force_raw" if walk.recording.raw else "mean_force_N"
        assert 0.0 < step[mean] < step[force]
    return len(steps["side"])


@pytest.mark.parametrize(
    "name", ["emed_step.lst", "fscan_walk_left.asf", "moticon_walk_a.txt", "pedar_walk.asc", "xsensor_walk.csv"]
)
def test_bounds_of_recordings(real_data, name):
    assert _check_bounds(analyse(real_data / "recordings" / name)) > 0


@pytest.mark.parametrize("seed", range(0, 60, 7))
def test_bounds_of_made_files(tmp_path, seed):
    made_table(seed, tmp_path / "walk.csv")
    assert _check_bounds(analyse(tmp_path / "walk.csv")) > 0


def test_angles_have_a_circular_mean():
    found = spread([175.0, -175.0, 179.0, -179.0], circular=True)
    assert abs(abs(found.mean or 0.0) - 180.0) < 1e-6
    assert (found.sd or 0.0) < 6.0


@pytest.mark.parametrize(("freedom", "true"), [(1.0, 12.706204736), (2.0, 4.30265272991), (3.0, 3.18244630528)])
def test_students_quantile_of_small_samples(freedom, true):
    assert student_quantile(0.975, freedom) == pytest.approx(true, rel=1e-9)
