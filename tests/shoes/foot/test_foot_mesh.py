"""Tests of feet from a surface: units, sole plane, frames, and bodies that are no foot."""

import json

import numpy as np
import pytest
import shapely
import trimesh

from plantar.errors import FootError, InputError
from plantar.shoes.foot.foot_mesh import foot_from_mesh, foot_from_triangles

from ..foot_family import rounded


@pytest.mark.parametrize(
    ("scale", "unit", "note"),
    [
        (1.0, None, "unit mm, detected from the size (200 mm long)"),
        (1e-3, None, "unit m, detected from the size (0.2 m long)"),
        (0.1, "cm", "unit cm as given"),
        (1 / 25.4, "in", "unit in as given"),
    ],
)
def test_the_unit_is_found_and_stated(box, stl, scale, unit, note):
    foot = foot_from_mesh(stl(box((-50, 150), (-40, 40), (10, 70)) * scale), unit=unit)
    assert note in foot.notes
    assert foot.sole.bounds == pytest.approx((-50, -40, 150, 40), abs=2e-3)
    assert foot.height == pytest.approx(60, abs=1e-3)
    assert any("sole plane at the mesh's lowest point, z = 10.0 mm" in n for n in foot.notes)


@pytest.mark.parametrize(
    ("length", "unit", "message"),
    [
        (
            25.2,
            None,
            r"fits neither m nor mm; allowed: a foot of 60 to 450 mm \(--unit cm, 252 mm long\), without a leg",
        ),
        (9.9, None, r"\(--unit cm, 99 mm long or --unit in, 251.5 mm long\)"),
        (252.0, "m", r"the foot is 252000 mm long \(unit m as given\); allowed: .*\(--unit mm, 252 mm long\)"),
        (1.0, "m", r"1000 mm long \(unit m as given\); allowed: a foot of 60 to 450 mm, without a leg or a floor that"),
    ],
)
def test_a_length_that_fits_no_foot_is_refused_with_the_unit_that_would_fit(box, stl, length, unit, message):
    with pytest.raises(FootError, match=message):
        foot_from_mesh(stl(box((0, length), (0, 0.4 * length), (0, 0.3 * length))), unit=unit)


def test_another_sole_plane_and_forward_axis_can_be_given(box, stl):
    # Along y: a foot of 200 x 80 with a stud below its sole.
    body = np.concatenate([box((-40, 40), (-50, 150), (0, 60)), box((-5, 5), (0, 10), (-8, 0))])
    with pytest.raises(FootError, match="no flat sole"):
        foot_from_mesh(stl(body))
    foot = foot_from_mesh(stl(body), sole_z=0.0, forward="y")
    assert foot.sole.equals(shapely.box(-50, -40, 150, 40))
    assert any("8.0 mm of the mesh lie below the sole plane and are ignored" in n for n in foot.notes)
    assert foot_from_mesh(stl(body), sole_z=0.0, forward="-y").sole.equals(shapely.box(-150, -40, 50, 40))


@pytest.mark.parametrize("forward", ["x", "-x", "y", "-y"])
def test_a_turned_foot_is_the_same_foot(prism, stl, forward):
    outline = np.array([[-60, -40], [120, -30], [140, 10], [110, 50], [-60, 35]], dtype=float)
    turn = {"x": [[1, 0], [0, 1]], "-x": [[-1, 0], [0, -1]], "y": [[0, -1], [1, 0]], "-y": [[0, 1], [-1, 0]]}[forward]
    foot = foot_from_mesh(stl(prism(outline @ np.array(turn).T, 0, 50)), forward=forward)
    assert foot.sole.equals(shapely.Polygon(outline))


def test_a_right_foot_is_mirrored_to_the_left(prism, stl):
    outline = np.array([[-60, -40], [120, -30], [140, 10], [110, 50], [-60, 35]], dtype=float)
    left = foot_from_mesh(stl(prism(outline, 0, 50)))
    right = foot_from_mesh(stl(prism(outline * [1, -1], 0, 50)), mesh_side="right")
    assert right.sole.equals(left.sole)


def test_a_foot_that_widens_upwards_has_an_outline_for_every_height(box, stl):
    body = np.concatenate([box((-50, 150), (-40, 40), (0, 8)), box((-60, 170), (-50, 55), (8, 60))])
    foot = foot_from_mesh(stl(body))
    assert foot.sole.bounds == (-50, -40, 150, 40)
    assert foot.outline_up_to(12.0).bounds == (-60, -50, 170, 55)


def test_open_meshes_and_far_origins_are_noted(box, stl):
    body = box((-50, 150), (-40, 40), (0, 60))
    assert not any("not closed" in n or "far from the sole" in n for n in foot_from_mesh(stl(body)).notes)
    assert any("not closed" in n for n in foot_from_mesh(stl(body[1:])).notes)
    assert any("far from the sole" in n for n in foot_from_mesh(stl(body + np.array([900, 0, 0]))).notes)


def test_a_rounded_foot_is_refused_with_the_band_that_takes_it(stl):
    ellipsoid = stl(trimesh.creation.icosphere(subdivisions=4).triangles * (110.0, 50.0, 30.0))
    with pytest.raises(FootError, match=r"5 mm cover 30 % .*\(or give --set sole_band=10 for a rounded sole"):
        foot_from_mesh(ellipsoid)
    assert foot_from_mesh(ellipsoid, sole_band=10.0).sole.area > 0.4 * np.pi * 110.0 * 50.0


def test_bodies_that_are_no_foot_are_refused(box, stl):
    with pytest.raises(
        FootError, match=r"no flat sole: the lowest 5 mm cover 16 % .*\(or give the sole plane's height"
    ):
        foot_from_mesh(stl(trimesh.creation.icosphere(radius=60.0).triangles))
    with pytest.raises(FootError, match="is a block, not a foot"):
        foot_from_mesh(stl(box((0, 100), (0, 100), (0, 100))))
    with pytest.raises(FootError, match=r"0\.4 mm high .* allowed: a foot's body of 0\.5 mm or more"):
        foot_from_mesh(stl(box((0, 200), (0, 100), (0, 0.4))))
    for scale in (1.0, 1e-3):
        with pytest.raises(FootError, match="fits neither m nor mm; allowed: a foot of 60 to 450 mm"):
            foot_from_mesh(stl(box((0, 5000), (0, 2000), (0, 900)) * scale))
    with pytest.raises(FootError, match="5000 mm long"):
        foot_from_mesh(stl(box((0, 5), (0, 2), (0, 1))), unit="m")
    with pytest.raises(FootError, match="the sole is 200 x 8 mm"):
        foot_from_mesh(stl(box((0, 200), (0, 8), (0, 60))))
    with pytest.raises(FootError, match="above the sole plane"):
        foot_from_mesh(stl(box((0, 200), (0, 80), (0, 60))), sole_z=500.0)
    with pytest.raises(FootError, match="no surface in its lowest 5 mm"):
        foot_from_mesh(stl(box((0, 200), (0, 80), (0, 60))), sole_z=-500.0)
    with pytest.raises(InputError, match="allowed: x, -x, y, -y"):
        foot_from_mesh(stl(box((0, 200), (0, 80), (0, 60))), forward="z")


def test_a_plate_is_a_foot_whichever_way_it_lies(box, stl):
    plate = box((-60, 140), (-50, 50), (0, 2.0))
    for order in ((0, 1, 2), (0, 2, 1)):
        foot = foot_from_mesh(stl(plate[..., order]))
        assert (round(foot.sole.area), foot.height) == (20_000, 2.0)
        assert any("a plate of 2 mm" in note for note in foot.notes)


@pytest.mark.long
def test_a_surface_whose_triangles_do_not_join_has_the_outline_of_one_that_does():
    foot = rounded(160, 20)
    apart = foot + np.random.default_rng(0).normal(0.0, 0.005, (len(foot), 1, 3))
    soles = [foot_from_triangles("a", t, where="a").sole for t in (foot, apart)]
    assert soles[0].symmetric_difference(soles[1]).area < 0.002 * soles[0].area


def test_a_square_flat_foot_is_a_foot(box, stl):
    assert foot_from_mesh(stl(box((0, 120), (0, 120), (0, 40)))).sole.area == pytest.approx(120 * 120)


@pytest.mark.parametrize("name", ["jvrc1", "talos", "robotis_op3"])
def test_real_feet_have_their_known_soles(real_data, name):
    truth = json.loads((real_data / "feet" / f"{name}.json").read_text())
    foot = foot_from_mesh(real_data / "feet" / f"{name}.stl")
    assert foot.sole.area == pytest.approx(truth["lowest_5mm"]["hull_area_mm2"], rel=2e-3)
    low_x, low_y, high_x, high_y = foot.sole.bounds
    np.testing.assert_allclose([low_x, high_x], truth["lowest_5mm"]["x_mm"], atol=0.15)
    np.testing.assert_allclose([low_y, high_y], truth["lowest_5mm"]["y_mm"], atol=0.15)
    reference = shapely.Polygon(truth["outline_hull_mm"])
    assert foot.sole.hausdorff_distance(reference) < 0.5  # the reference is simplified
    assert any(n.startswith("unit m") for n in foot.notes)
    assert any("not closed" in n for n in foot.notes) == (not truth["watertight"])


def test_a_foot_along_y_is_turned_by_its_ankle(box, stl):
    for ends, axis in (((-50, 150), "y"), ((-150, 50), "-y")):
        foot = foot_from_mesh(stl(box((-40, 40), ends, (0, 60))))
        assert foot.sole.equals(shapely.box(-50, -40, 150, 40))
        assert any(f"its origin lies nearer to the heel: {axis} points to the toes" in n for n in foot.notes)
    ankle = np.concatenate([box((400, 480), (500, 700), (0, 30)), box((420, 460), (640, 690), (30, 90))])
    foot = foot_from_mesh(stl(ankle))  # the origin is far away: the ankle above tells
    assert foot.sole.bounds == pytest.approx((-100, -40, 100, 40))
    assert any("its uppermost part lies nearer to the heel: -y" in n for n in foot.notes)


@pytest.mark.parametrize(("up", "axes"), [("y", (0, 2, 1)), ("-x", (2, 1, 0)), ("-z", (0, 1, 2))])
def test_another_axis_may_point_up(prism, stl, up, axes):
    outline = np.array([[-60, -40], [120, -30], [140, 10], [110, 50], [-60, 35]], dtype=float)
    from plantar.shoes.foot.orientation import rotation_up

    standing = np.concatenate([prism(outline, 0, 20), prism(outline * 0.5, 20, 70)])
    foot = foot_from_mesh(stl(standing @ rotation_up(up)), up=up)
    assert foot.sole.bounds == pytest.approx((-60, -40, 140, 50))
    assert any(f"the mesh's {up} axis points up, as given" in n for n in foot.notes)


def test_a_foot_that_lies_on_its_side_is_put_up(stl, prism):
    side = np.array([[-60, 0], [140, 0], [140, 15], [40, 50], [20, 120], [-30, 120], [-60, 40]], dtype=float)
    upright = prism(side, -45, 45)[..., [0, 2, 1]][:, ::-1]  # x forward, z up, extruded along y
    foot = foot_from_mesh(stl(upright))
    lying = foot_from_mesh(stl(upright[..., [0, 2, 1]][:, ::-1]), up="y")
    assert lying.sole.bounds == pytest.approx(foot.sole.bounds)


def test_a_foot_that_hangs_upside_down_is_put_up_by_the_links_above_it(box):
    foot, shin = box((-80, 140), (-45, 55), (-80, -50)), np.array([[0.0, 0.0, 10.0], [10.0, 0.0, 30.0]])
    down = np.array([1.0, -1.0, -1.0])
    upright, turned = (foot_from_triangles("a", foot * d, where="a", links=shin * d) for d in (np.ones(3), down))
    assert turned.sole.equals_exact(upright.sole, 1e-6)
    assert turned.notes[1].startswith("the robot's links are below its foot")


def test_a_foot_that_rests_on_a_slanted_side_is_put_up(prism, box, stl):
    # Levelled on its outer side, which is 6 degrees askew, origin and ankle would contradict each other.
    outline = np.array([[-75, -36], [60, -50], [130, -12], [138, 26], [118, 54], [40, 60], [-72, 34]], dtype=float)
    standing = np.concatenate([prism(outline, 0, 28), box((-22, 22), (-24, 24), (15, 70))])
    foot = foot_from_mesh(stl(standing[..., [0, 2, 1]] * np.array([1.0, -1.0, 1.0])))
    assert foot.sole.bounds == pytest.approx((-75, -50, 138, 60), abs=0.01)
    assert any("-y axis is taken to point up" in n for n in foot.notes)


def test_a_tilted_sole_is_levelled(box, stl):
    angle = np.radians(6.0)
    turn = np.array([[np.cos(angle), 0, -np.sin(angle)], [0, 1, 0], [np.sin(angle), 0, np.cos(angle)]])
    body = np.concatenate([box((-50, 150), (-40, 40), (0, 60)), box((-20, 20), (-20, 20), (60, 90))])
    foot = foot_from_mesh(stl(body @ turn.T))
    assert foot.sole.bounds == pytest.approx((-50, -40, 150, 40), abs=0.01)
    assert any("tilted by 6.0 degrees" in n for n in foot.notes)
    assert np.ptp(foot.triangles[..., 2]) == pytest.approx(90.0, abs=0.01)


def test_what_touches_the_floor_is_told(generated_feet):
    from plantar.shoes.foot.foot_mesh import foot_from_triangles

    far = foot_from_triangles("a", generated_feet["far_patches"], where="a")
    assert far.support.area == pytest.approx(80 * 90 + 100 * 100)
