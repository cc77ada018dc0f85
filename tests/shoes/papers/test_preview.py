"""Tests of the preview: a picture of a mesh and of a foot of which only the sizes are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.shoes import Foot
from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.papers.preview import draw_preview


def test_a_foot_is_drawn_with_its_axes(
    small_foot: Foot, generated_feet: dict[str, NDArray[np.float64]], tmp_path: Path
) -> None:
    mesh = foot_from_triangles("a", generated_feet["toe_out"], where="a")
    for foot, name in ((small_foot, "box"), (mesh, "mesh")):
        text = draw_preview(foot, tmp_path / f"{name}.svg").read_text()
        for word in ("toes, x", "left, y", "sole plane", "below the ankle"):
            assert word in text
