"""Tests of the renderer: what is in front is seen, where it is, in its colour."""

import numpy as np

from plantar.shoes.foot.foot_mesh import foot_from_triangles
from plantar.shoes.papers.picture import draw_preview, render

RED, GREEN = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)


def test_a_box_from_above_fills_its_rectangle(box):
    picture = render([(box((0, 40), (0, 20), (0, 10)), RED)], azimuth=-90.0, elevation=90.0, width=400, margin=0.1)
    assert picture.shape[1:] == (400, 3)
    assert abs(picture.shape[0] - 240) <= 1
    seen = (picture < 0.99).any(axis=2)
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    assert (columns[0], columns[-1]) == (40, 359)  # x to the right, at 8 pixels a mm
    assert (rows[0], rows[-1]) == (40, 199)
    assert (picture[100:140, 100:300, 0] > 0.8).all()
    assert (picture[100:140, 100:300, 1:] == 0.0).all()


def test_the_nearer_body_hides_the_other(box):
    low, high = box((0, 40), (0, 40), (0, 5)), box((10, 30), (10, 30), (20, 25))
    above = render([(low, RED), (high, GREEN)], azimuth=-90.0, elevation=90.0, width=200)
    below = render([(low, RED), (high, GREEN)], azimuth=-90.0, elevation=-90.0, width=200)
    middle = above.shape[0] // 2
    assert above[middle, 100].argmax() == 1
    assert below[middle, 100].argmax() == 0
    assert (render([(low, RED)], azimuth=0.0, elevation=30.0, width=60) >= 0.0).all()


def test_a_foot_is_drawn_with_its_axes(small_foot, generated_feet, tmp_path):
    mesh = foot_from_triangles("a", generated_feet["toe_out"], where="a")
    for foot, name in ((small_foot, "box"), (mesh, "mesh")):
        text = draw_preview(foot, tmp_path / f"{name}.svg").read_text()
        for word in ("toes, x", "left, y", "sole plane", "below the ankle"):
            assert word in text
