"""Averaging of the CoP path, and its distance to the sole's edge."""

import numpy as np
import pytest

from plantar import hex_layout
from plantar.gait.analysis.steps.cop_path import averaged_path, cop_measures, margin_to_outline
from plantar.geometry.polygon import signed_margin


def test_an_even_motion_is_kept_to_its_ends():
    points = np.column_stack([np.linspace(0.0, 0.2, 60), np.linspace(0.05, 0.0, 60)])
    points[:5] = points[-7:] = points[30] = np.nan
    out = averaged_path(points, np.ones(60), 12)
    known = np.isfinite(points[:, 0])
    assert out[known] == pytest.approx(points[known])
    assert np.isnan(out[~known]).all()


def test_noise_is_averaged_and_force_is_the_weight():
    random = np.random.default_rng(0)
    points = random.normal(0.0, 0.01, (1000, 2))
    out = averaged_path(points, np.ones(1000), 12)
    assert out[50:-50].std() == pytest.approx(0.01 / np.sqrt(13), rel=0.1)
    two = averaged_path(np.array([[0.0, 0.0], [1.0, 1.0], [0.0, 0.0]]), np.array([1.0, 2.0, 1.0]), 2)
    assert two[1] == pytest.approx([0.5, 0.5])


def test_margin_is_that_of_the_nearest_point_to_the_edge():
    layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
    points = np.array([[0.1, 0.05], [0.19, 0.04], [0.1, 0.03]])
    assert margin_to_outline(layout, points) == pytest.approx(0.01)
    outside = np.array([[0.1, 0.05], [0.1, 0.12]])
    assert margin_to_outline(layout, outside) == pytest.approx(signed_margin(layout.outline, outside[1])) == -0.02


@pytest.mark.parametrize("rate", [50.0, 100.0, 400.0])
@pytest.mark.parametrize("noise", [0.0, 0.4e-3])
def test_speed_depends_on_neither_rate_nor_noise(rate, noise):
    """A path along the sole at 0.3 m/s, whose noise frame by frame would lengthen it by up to 90 %."""
    time = np.arange(0.0, 0.7, 1.0 / rate)
    points = np.column_stack([0.3 * time, 0.01 * np.sin(4.0 * time)])
    points = points + np.random.default_rng(0).normal(0.0, noise, points.shape)
    found = cop_measures(time, points)
    assert found["cop_velocity_m_s"] == pytest.approx(0.3015, rel=0.01)
    assert found["cop_path_m"] == pytest.approx(found["cop_velocity_m_s"] * (time[-1] - time[0]))
