"""Tests of drawings: DXF, SVG and GeoJSON give the outline that is drawn."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely

from plantar.errors import FootError, InputError
from plantar.shoes.foot.outline_file import foot_from_drawing

RING = [[-60, -40], [120, -30], [140, 10], [110, 50], [-60, 35]]
OUTLINE = shapely.Polygon(RING)


def dxf(path: Path, units: int = 4, scale: float = 1.0) -> Path:
    import ezdxf

    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    space = document.modelspace()
    points = (np.array(RING) * scale).tolist()
    space.add_lwpolyline(points[:3])  # in pieces that meet
    space.add_line(points[2], points[3])
    space.add_lwpolyline([points[3], points[4], points[0]])
    space.add_text("sole of the foot")
    document.saveas(path)
    return path


def svg(path: Path, body: str, head: str = 'width="200mm" viewBox="0 0 200 100"') -> Path:
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {head}>{body}</svg>')
    return path


def geojson(path: Path, scale: float = 1.0) -> Path:
    ring = (np.array([*RING, RING[0]]) * scale).tolist()
    feature = {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [ring]}}
    path.write_text(json.dumps({"type": "FeatureCollection", "features": [feature]}))
    return path


def test_every_kind_gives_the_same_outline(tmp_path):
    up = " ".join(f"{x},{-y}" for x, y in RING)
    pieces = f'<g transform="translate(10 5)"><polygon transform="translate(-10,-5)" points="{up}"/></g>'
    for path, note in (
        (dxf(tmp_path / "mm.dxf"), "unit mm as the file states"),
        (dxf(tmp_path / "m.dxf", 6, 1e-3), "unit m as the file states"),
        (dxf(tmp_path / "feet.dxf", 2, 1.0 / 304.8), "unit in as the file states"),
        (dxf(tmp_path / "none.dxf", 0, 1e-3), "unit m, detected"),
        (svg(tmp_path / "a.svg", pieces), "unit mm as the file states"),
        (svg(tmp_path / "half.svg", f'<polygon points="{up}"/>', 'width="20cm" viewBox="0 0 200 100"'), "unit cm as"),
        (
            svg(tmp_path / "px.svg", f'<polygon points="{up}"/>', f'width="{20 / 2.54 * 96}px" viewBox="0 0 200 100"'),
            "unit in as the file states",
        ),
        (
            svg(tmp_path / "pt.svg", f'<polygon points="{up}"/>', f'width="{20 / 2.54 * 72}pt" viewBox="0 0 200 100"'),
            "unit in as the file states",
        ),
        (svg(tmp_path / "plain.svg", f'<path d="M {up} z"/>', ""), "unit mm, detected"),
        (geojson(tmp_path / "a.geojson"), "unit mm, detected"),
        (geojson(tmp_path / "m.json", 1e-3), "unit m, detected"),
    ):
        foot = foot_from_drawing(path)
        assert foot.sole.symmetric_difference(OUTLINE).area < 15.0, path.name
        assert note in foot.notes[0], path.name
        assert any("sides are taken to be upright" in n for n in foot.notes)


def test_a_unit_that_cannot_be_is_refused_with_those_that_would_do(tmp_path):
    path = dxf(tmp_path / "wrong.dxf", 6, 1.0)  # drawn in mm, marked as m
    with pytest.raises(FootError, match=r"200000 mm long \(unit m as the file states\).*\(--unit mm, 200 mm long\)"):
        foot_from_drawing(path)
    assert foot_from_drawing(path, unit="mm").notes[0] == "unit mm as given"


def test_curves_are_followed(tmp_path):
    import ezdxf

    document = ezdxf.new(units=4)
    document.modelspace().add_ellipse((30, 0), (100, 0), ratio=0.45)
    document.saveas(tmp_path / "e.dxf")
    ellipse = "<ellipse cx='30' cy='0' rx='100' ry='45'/>"
    arcs = "<path d='M-70 0 A100 45 0 0 1 130 0 A100 45 0 0 1 -70 0 Z'/>"
    beziers = (
        "<path d='M-70,0 C-70,-24.85 -25.2,-45 30,-45 S130,-24.85 130,0 S85.2,45 30,45 S-70,24.85 -70,0'/>"
        "<defs><rect width='900' height='900'/></defs>"
    )
    for path in (
        tmp_path / "e.dxf",
        svg(tmp_path / "e.svg", ellipse),
        svg(tmp_path / "arc.svg", arcs),
        svg(tmp_path / "b.svg", beziers),
        svg(tmp_path / "turned.svg", f"<g transform='rotate(180, 30, 0)'>{ellipse}</g>"),
    ):
        assert foot_from_drawing(path).sole.area == pytest.approx(np.pi * 100 * 45, rel=6e-3), path.name


def test_the_toes_the_side_and_the_origin_are_found_or_given(tmp_path):
    right = foot_from_drawing(geojson(tmp_path / "a.geojson"), mesh_side="right")
    assert right.sole.symmetric_difference(shapely.affinity.scale(OUTLINE, 1, -1, origin=(0, 0))).area < 15.0
    (tmp_path / "up.geojson").write_text(
        json.dumps({"type": "Polygon", "coordinates": [[[300, 100], [380, 100], [380, 320], [300, 320]]]})
    )
    turned = foot_from_drawing(tmp_path / "up.geojson")
    assert turned.sole.bounds == pytest.approx((-110.0, -40.0, 110.0, 40.0), abs=0.05)
    assert any("its longer side" in n for n in turned.notes)
    assert any("origin lies outside" in n for n in turned.notes)
    back = foot_from_drawing(geojson(tmp_path / "a.geojson"), forward="-x")
    assert back.sole.bounds == pytest.approx((-140, -50, 60, 40), abs=0.1)
    with pytest.raises(InputError, match="allowed: x, -x, y, -y"):
        foot_from_drawing(geojson(tmp_path / "a.geojson"), forward="z")


def test_bad_drawings_are_refused_in_one_line(tmp_path):
    open_line = json.dumps({"type": "LineString", "coordinates": [[0, 0], [200, 0], [200, 80]]})
    cases = {
        "empty.dxf": ("", "is empty"),
        "text.dxf": ("hello", "not a DXF drawing that can be read"),
        "cut.svg": ("<svg><path d='M0 0", "not a readable XML"),
        "none.svg": ("<svg/>", "holds no lines"),
        "bad.svg": ("<svg><path d='M 0 0 L 10 x'/></svg>", "not a readable SVG|no closed line|has no size"),
        "turn.svg": ("<svg><g transform='warp(3)'><rect width='9' height='9'/></g></svg>", "transform 'warp'"),
        "a.geojson": ("{", "is not a readable GeoJSON"),
        "b.geojson": ('{"type": "Potato"}', "type is 'Potato'"),
        "c.geojson": (open_line, "no closed line"),
        "d.geojson": ('{"type": "Polygon", "coordinates": [[[0, 0], [1e999, 0], [0, 1]]]}', "not finite"),
        "e.geojson": (
            '{"type": "Polygon", "coordinates": [[[0, 0], [5000, 0], [5000, 900]]]}',
            "fits neither m nor mm",
        ),
        "f.png": ("x", "no drawing that is read"),
    }
    for name, (text, reason) in cases.items():
        (tmp_path / name).write_text(text)
        with pytest.raises(FootError, match=reason) as caught:
            foot_from_drawing(tmp_path / name)
        assert "\n" not in str(caught.value)
        assert name in str(caught.value)
    with pytest.raises(FootError, match="cannot be read"):
        foot_from_drawing(tmp_path / "missing.svg")


@pytest.mark.parametrize("kind", ["svg", "geojson"])
def test_an_outline_that_crosses_itself_is_refused(tmp_path, kind):
    eight = [[0, 0], [240, 95], [240, 0], [0, 95]]
    path = tmp_path / f"eight.{kind}"
    if kind == "svg":
        svg(path, f'<polygon points="{" ".join(f"{x},{y}" for x, y in eight)}"/>')
    else:
        path.write_text(json.dumps({"type": "Polygon", "coordinates": [[*eight, eight[0]]]}))
    with pytest.raises(FootError, match="crosses itself"):
        foot_from_drawing(path)


def test_two_feet_in_a_drawing_are_refused(tmp_path):
    up = " ".join(f"{x},{-y}" for x, y in RING)
    both = f'<polygon points="{up}"/><polygon transform="translate(0 120)" points="{up}"/>'
    path = svg(tmp_path / "pair.svg", both)
    with pytest.raises(
        FootError, match="outlines apart from each other, two feet maybe; draw one, or give the forward"
    ):
        foot_from_drawing(path)
    assert foot_from_drawing(path, forward="x").sole.area > 2.0 * OUTLINE.area


def test_what_is_hidden_is_not_drawn(tmp_path):
    import ezdxf

    path = dxf(tmp_path / "hidden.dxf")
    document = ezdxf.readfile(path)
    document.layers.add("sheet").off()
    document.modelspace().add_circle((0, 0), 200, dxfattribs={"layer": "Sheet"})
    document.saveas(path)
    up = " ".join(f"{x},{-y}" for x, y in RING)
    sheet = "<rect x='-90' y='-90' width='300' height='200' {}/>"
    for look in ("style='fill:none; display: none'", "display='none'"):
        drawn = svg(tmp_path / "hidden.svg", f"{sheet.format(look)}<polygon points='{up}'/>")
        for file in (path, drawn):
            assert foot_from_drawing(file).sole.symmetric_difference(OUTLINE).area < 15.0


def test_ends_that_overlap_are_no_crossing(tmp_path):
    up = " ".join(f"{x},{-y}" for x, y in [*RING, [-60, -41], [-58, -38]])
    foot = foot_from_drawing(svg(tmp_path / "a.svg", f'<path d="M {up}"/>'))
    assert foot.sole.symmetric_difference(OUTLINE).area < 100.0


def test_holes_are_left_out_aloud(tmp_path):
    hole = [[0, 0], [10, 0], [10, 10], [0, 10]]
    path = tmp_path / "hole.geojson"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [[*RING, RING[0]], [*hole, hole[0]]]}))
    foot = foot_from_drawing(path)
    assert foot.sole.symmetric_difference(OUTLINE).area < 15.0
    assert any("1 line(s) within the outline left out" in note for note in foot.notes)
    assert not any("left out" in note for note in foot_from_drawing(geojson(tmp_path / "a.geojson")).notes)


@pytest.mark.parametrize(("turn", "said"), [(0.0, False), (5.0, False), (37.0, True), (90.0, False), (-30.0, True)])
def test_a_sole_askew_on_the_sheet_is_pointed_out(tmp_path, turn, said):
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    ring = (np.array([[-80, -35], [120, -35], [120, 35], [-80, 35]]) @ np.array([[c, s], [-s, c]])).tolist()
    path = tmp_path / "turned.geojson"
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [[*ring, ring[0]]]}))
    assert any("askew" in note and f"{abs(turn):.0f} degrees" in note for note in foot_from_drawing(path).notes) == said


def test_blocks_of_a_dxf_and_used_shapes_of_an_svg_are_drawn(tmp_path):
    import ezdxf

    document = ezdxf.new(units=4)
    block = document.blocks.new("sole")
    block.add_lwpolyline([(x - 7.0, y) for x, y in RING], close=True)
    document.modelspace().add_blockref("sole", (7.0, 0.0))
    document.saveas(tmp_path / "block.dxf")
    up = " ".join(f"{x},{-y}" for x, y in RING)
    shape = f'<defs><g id="a" transform="translate(-3 0)"><polygon points="{up}"/></g></defs><use href="#a" x="3"/>'
    for file in (tmp_path / "block.dxf", svg(tmp_path / "use.svg", shape)):
        assert foot_from_drawing(file).sole.symmetric_difference(OUTLINE).area < 1.0
    for loop in ('<g id="a"><use href="#a"/></g>', '<use href="#none"/>'):
        with pytest.raises(FootError):
            foot_from_drawing(svg(tmp_path / "loop.svg", loop))
