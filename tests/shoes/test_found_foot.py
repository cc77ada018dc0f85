"""The shoes of a foot that was found in a robot's model."""

import numpy as np
import pytest
import trimesh

from plantar.layouts.layout_file import read_layout
from plantar.shoes.found_foot import shoe_for_surface


@pytest.mark.parametrize("gap", [0.0, 0.12])
def test_a_shoe_feels_the_ground_between_two_parts_of_a_sole(tmp_path, gap):
    parts = [((0.24, 0.1, 0.04), (0.05, 0.0, 0.04))]
    parts += [((0.5 * (0.24 - gap), 0.1, 0.02), (0.05 + s * 0.25 * (0.24 + gap), 0.0, 0.01)) for s in (-1.0, 1.0)]
    boxes = [trimesh.creation.box(size, trimesh.transformations.translation_matrix(place)) for size, place in parts]
    surface = np.concatenate([box.triangles for box in boxes])
    made = shoe_for_surface("foot", surface, tmp_path, 40.0)
    assert made.thickness > 0.0
    layout = read_layout(tmp_path / "layout_left.json")
    between = np.abs(layout.positions[:, 0] - 0.05) < 0.03
    assert 5 <= between.sum() < 0.5 * len(layout)
