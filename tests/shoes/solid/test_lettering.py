"""Tests of letters: they differ, have the height asked for, and leave no fins."""

import pytest
import shapely

from plantar.shoes.solid.lettering import lettering


def test_every_letter_is_its_own():
    letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./"
    shapes = [lettering(c, 10.0) for c in letters]
    assert all(s.is_valid and s.area > 1.0 for s in shapes)
    assert len({round(s.area, 3) for s in shapes}) >= len(letters) - 2
    for a, b in (("L", "R"), ("O", "0"), ("I", "1"), ("S", "5")):
        assert lettering(a, 10.0).symmetric_difference(lettering(b, 10.0)).area > 1.0


def test_a_line_is_as_high_as_asked_and_runs_to_the_right():
    line = lettering("L h1", 8.0)
    assert line.bounds[3] - line.bounds[1] == pytest.approx(8.0 + 0.9 * 8.0 / 6.0, abs=0.4)
    assert line.bounds[2] > 3 * 8.0
    assert line.equals(lettering("l H1", 8.0))
    assert lettering("", 8.0).is_empty
    assert lettering("é?", 8.0).is_empty


def test_nothing_narrow_is_left_between_strokes():
    for letter in "AMKRW8":
        shape = lettering(letter, 9.0)
        closed = shape.buffer(0.5).buffer(-0.5)
        assert (closed - shape).area < 0.6  # but for the corners
        assert isinstance(shape, shapely.MultiPolygon)


def test_straight_strokes_have_no_more_corners_than_they_need():
    for letter, corners in (("L", 6), ("E", 12), ("H", 12), ("T", 8)):
        assert [len(part.exterior.coords) - 1 for part in lettering(letter, 8.0).geoms] == [corners]
