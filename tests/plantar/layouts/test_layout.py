import dataclasses
import math
import pickle

import numpy as np
import pytest
import shapely

from plantar import InputError, LayoutError, SoleLayout, mirrored
from plantar.layouts.layout import CELL_SHAPES, DEFAULT_RANGES, MODALITIES

FIELDS = {f.name for f in dataclasses.fields(SoleLayout)}
ARRAYS = ("positions", "rotations", "vertices", "areas", "outline", "ids")


def changed(layout, **fields):
    return dataclasses.replace(layout, **fields)


def test_arrays_are_read_only_and_of_one_type(sole):
    for name in ARRAYS:
        array = getattr(sole, name)
        assert array.dtype == (np.int64 if name == "ids" else np.float64)
        with pytest.raises(ValueError, match="read-only"):
            array[:1] = 0
    with pytest.raises(ValueError, match="read-only"):
        sole.wrench_map[0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        sole.name = "other"


def test_a_layout_keeps_no_hold_on_what_it_was_made_from(sole):
    positions = sole.positions.copy()
    layout = changed(sole, positions=positions)
    positions[:] = 9.0
    assert layout.positions.tolist() == sole.positions.tolist()


def test_lists_and_mappings_are_copied_in_and_closed(sole):
    given = {"force": 1.0}
    spans = {"force": [0.0, 300.0]}
    corners = [list(ring) for ring in sole.corners]
    layout = changed(sole, thresholds=given, ranges=spans, corners=corners)
    given["force"] = spans["force"][1] = 5.0
    corners[0][0] = 10**6
    assert layout.force_threshold == 1.0
    assert layout.force_limit == 300.0
    assert layout.corners == sole.corners
    for mapping in (layout.thresholds, layout.ranges, changed(sole).thresholds):
        with pytest.raises(TypeError, match="does not support item assignment"):
            mapping["force"] = 5.0
    again = pickle.loads(pickle.dumps(layout))
    assert (dict(again.thresholds), dict(again.ranges)) == ({"force": 1.0}, {"force": (0.0, 300.0)})


def test_what_a_layout_computes_is_read_only(sole):
    for array in (sole.wrench_map, sole.corner_start, sole.corner_vertex):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


@pytest.mark.parametrize("taxel", [-1, 10**6, 0.0, "0", None, [0]])
def test_a_cell_is_one_of_the_layout(sole, taxel):
    with pytest.raises(InputError, match=f"^taxel is .*allowed: a whole number, 0 to {len(sole) - 1}$"):
        sole.cell_polygon(taxel)


def test_sole_area_is_shapelys(sole):
    assert sole.sole_area == pytest.approx(shapely.Polygon(sole.outline).area)
    assert changed(sole, outline=sole.outline[::-1]).sole_area == pytest.approx(sole.sole_area)
    far = changed(sole, outline=sole.outline + 40.0)
    assert far.sole_area == pytest.approx(sole.sole_area, rel=1e-9)


def test_flat_views_of_the_corners_agree_with_the_rows(sole):
    rows = [
        sole.corner_vertex[a:b].tolist() for a, b in zip(sole.corner_start[:-1], sole.corner_start[1:], strict=True)
    ]
    assert rows == [list(c) for c in sole.corners]
    assert sole.cell_polygon(3).tolist() == [sole.vertices[i, :2].tolist() for i in sole.corners[3]]


def test_threshold_falls_back_to_the_papers(sole):
    assert changed(sole, thresholds={}).force_threshold == pytest.approx(0.15 * 9.81)
    assert changed(sole, thresholds={"force": 2.5}).force_threshold == 2.5


def test_a_sole_without_taxels_is_one(sole):
    empty = SoleLayout(
        name="bare",
        side="right",
        positions=np.empty((0, 3)),
        rotations=np.empty((0, 3, 3)),
        vertices=np.empty((0, 3)),
        corners=(),
        neighbours=(),
        areas=np.empty(0),
        outline=sole.outline,
        ids=np.empty(0, dtype=np.int64),
    )
    assert len(empty) == 0
    assert empty.wrench_map.shape == (6, 0)
    assert mirrored(empty).side == "left"


def test_mirroring_twice_gives_the_same_sole(sole):
    twice = mirrored(mirrored(sole))
    for name in (*ARRAYS, "corners", "neighbours", "side"):
        assert np.asarray(getattr(twice, name) if name not in ("corners", "neighbours") else 0).tolist() == (
            np.asarray(getattr(sole, name) if name not in ("corners", "neighbours") else 0).tolist()
        )
    assert (twice.corners, twice.neighbours) == (sole.corners, sole.neighbours)


def test_the_other_foot_is_a_mirror_image(sole):
    tilt = math.radians(20)
    turned = np.array([[1, 0, 0], [0, math.cos(tilt), -math.sin(tilt)], [0, math.sin(tilt), math.cos(tilt)]])
    left = changed(sole, rotations=np.broadcast_to(turned, (len(sole), 3, 3)))
    right = mirrored(left)
    assert (left.side, right.side) == ("left", "right")
    assert shapely.LinearRing(right.outline).is_ccw
    for i in range(len(left)):
        ring = right.cell_polygon(i)
        assert shapely.LinearRing(ring).is_ccw
        assert {tuple(p) for p in ring.tolist()} == {(x, -y) for x, y in left.cell_polygon(i).tolist()}
    # A push along a taxel's normal: force and position are mirrored, the moment, a pseudovector, the other way round.
    assert right.wrench_map == pytest.approx(left.wrench_map * np.array([[1, -1, 1, -1, 1, -1]]).T, abs=1e-15)
    assert np.linalg.det(right.rotations) == pytest.approx(np.ones(len(right)))


def bad_fields(n):
    """Field, bad value and what the message says beside the field's name."""
    eye = np.broadcast_to(np.eye(3), (n, 3, 3)).copy()
    flipped, stretched, huge = eye.copy(), eye.copy(), eye.copy()
    flipped[1] = np.diag([1.0, 1.0, -1.0])
    stretched[2] *= 1.001
    huge[0] *= 1e200
    ring, alone = (0, 1, 2), ((),) * n
    return [
        ("side", "middle", "allowed: left, right"),
        ("pose", [0.0, 0.0, 0.0], "pose"),
        ("positions", np.full((n, 3), 120.0), "allowed: within 50 m"),
        ("rotations", flipped, "not a rotation"),
        ("rotations", stretched, "not a rotation"),
        ("rotations", huge, "not a rotation"),
        ("vertices", [[0, 0, "x"]], "not numeric"),
        ("areas", np.zeros(n), "not above 0"),
        ("outline", [[0, 0], [1, 1]], "expected 3 or more"),
        ("outline", [[0, 0], [1, 1], [2, 2]], "no area"),
        ("outline", [[0, 0], [250, 0], [250, 100]], "within 50 m"),
        ("ids", np.zeros(n, dtype=int), "twice"),
        ("ids", [10**30] * n, "64 bits"),
        ("ids", np.arange(n) + 0.5, "whole numbers"),
        ("name", None, "expected a str"),
        ("corners", None, "list of indices"),
        ("corners", (("a", "b", "c"),) * n, "list of indices"),
        ("corners", ((0.0, 1.0, 2.0),) * n, "list of indices"),
        ("neighbours", 3, "list of indices"),
        ("neighbours", (None,) * n, "list of indices"),
        ("cell_area", "1", "expected a number"),
        ("modalities", 3, "expected a list"),
        ("modalities", ([],), ", ".join(MODALITIES)),
        ("cell_shape", [], ", ".join(CELL_SHAPES)),
        ("side", [], "allowed: left, right"),
        ("ranges", {"force": 5.0}, "expected (2,)"),
        ("ranges", {"force": "ab"}, "numeric"),
        ("ranges", None, "mapping"),
        ("thresholds", {"force": "1"}, "expected a number"),
        ("thresholds", [("force", 1.0)], "mapping"),
        ("noise", {"force": "1"}, "expected a number"),
        ("noise", None, "mapping"),
        ("noise", {"force": -1.0}, "0 or more"),
        ("calibrations", None, "mapping"),
        ("calibrations", {"both": None}, "allowed: left, right"),
        ("calibrations", {"left": 0.1}, "SoleCalibration"),
        ("noise", {"force": math.inf}, "finite"),
        ("corners", ((0, 1),) * n, "expected 3 or more"),
        ("corners", ((0, 1, -1),) * n, "does not exist"),
        ("corners", ((0, 1, 10**6),) * n, "does not exist"),
        ("corners", ((0, 1, 0),) * n, "twice"),
        ("neighbours", alone[1:], "expected"),
        ("neighbours", ((0,), *alone[1:]), "itself"),
        ("neighbours", ((n,), *alone[1:]), "does not exist"),
        ("neighbours", ((1,), *alone[1:]), "does not name it back"),
        ("cell_area", 0.0, "above 0"),
        ("cell_area", math.nan, "above 0"),
        ("cell_shape", "circle", ", ".join(CELL_SHAPES)),
        ("modalities", ("smell",), ", ".join(MODALITIES)),
        ("ranges", {"force": (5.0, 5.0)}, "low below high"),
        ("ranges", {"force": (0.0, math.inf)}, "finite"),
        ("thresholds", {"force": math.nan}, "finite"),
        ("thresholds", {"force": -1.0}, "0 or more"),
        ("corners", (ring,) * (n - 1), "expected"),
    ]


@pytest.mark.parametrize("case", range(len(bad_fields(1000))))
def test_a_bad_field_is_named(sole, case):
    field, value, text = bad_fields(len(sole))[case]
    with pytest.raises(LayoutError) as caught:
        changed(sole, **{field: value})
    message = str(caught.value)
    assert text in message
    assert "\n" not in message
    assert f"'{field}" in message or (field == "corners" and "expected" in text)


def test_every_field_with_a_rule_has_a_bad_case():
    assert {f for f, _, _ in bad_fields(5)} == FIELDS


def test_limits_of_the_modalities_come_from_the_layout_or_the_defaults(sole):
    stated = changed(
        sole,
        ranges={"force": (0.0, 300.0), "proximity": (0.0, 0.02)},
        thresholds={"proximity": 0.01, "temperature": 45.0},
    )
    assert (stated.force_limit, stated.proximity_range) == (300.0, 0.02)
    assert (stated.proximity_threshold, stated.temperature_threshold) == (0.01, 45.0)
    bare = changed(sole, ranges={}, thresholds={})
    assert (bare.force_limit, bare.proximity_range) == (math.inf, 0.05)
    assert (bare.proximity_threshold, bare.temperature_threshold) == (0.05, 31.0)


def test_a_full_load_on_one_cell_is_a_megapascal_not_the_80_that_are_printed():
    """T 4.2.1 prints 80 MPa for 80 kg on 6.9 cm^2."""
    pressure = DEFAULT_RANGES["force"][1] / 691e-6
    assert DEFAULT_RANGES["force"][1] == pytest.approx(80.0 * 9.81, abs=0.5)
    assert pressure == pytest.approx(1.1e6, rel=0.05)
