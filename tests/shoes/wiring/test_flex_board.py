"""The flexible board: counted from its file by text and shapely, by KiCad where it is, and its Gerbers against it."""

import io
import re
import shutil
import subprocess
import zipfile
from dataclasses import replace

import numpy as np
import pytest
import shapely

from plantar.shoes import build_shoe, foot_from_dimensions
from plantar.shoes.cells.cell import read_cell
from plantar.shoes.checks.board_count import count_board
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.wiring import hole_outline, pocket_outlines
from plantar.shoes.wiring.flex_board import comb_shapes, flex_board, mirrored_board
from plantar.shoes.wiring.gerber_files import gerber_zip
from plantar.shoes.wiring.grid_router import CLEARANCE, EDGE
from plantar.shoes.wiring.kicad_board import kicad_text


@pytest.fixture(scope="module")
def boards(wired_builds):
    build = wired_builds["velostat"]
    return [
        (shoe, build, board, kicad_text(board))
        for shoe in build.shoes
        for board in [flex_board(shoe, build.parameters)]
    ]


def _problems(shoe, build, text):
    count = count_board(text)
    wanted = {
        f"T{k}": (f"R{r}", f"C{c}")
        for k, (r, c) in zip(shoe.layout.ids.tolist(), shoe.plan.lines.tolist(), strict=True)
    }
    assert count.taxels == wanted
    assert len(set(wanted.values())) == len(wanted)
    assert count.open_nets == ()
    assert count.clearance > CLEARANCE - 1e-3
    assert count.hole > CLEARANCE
    assert count.edge > EDGE - 1e-3
    openings = shapely.union_all(
        [*pocket_outlines(shoe.plan, build.parameters), hole_outline(shoe.plan, build.parameters)]
    )
    assert (count.outline & shoe.plan.contact).difference(openings.buffer(1e-3)).area < 0.5
    return count


def test_each_taxel_is_on_one_row_and_one_column_that_lead_to_the_tail(boards):
    for shoe, build, board, text in boards:
        count = _problems(shoe, build, text)
        assert count.tail == board.tail


def _same_board(board, other):
    assert board.side == other.side
    assert board.tail == other.tail
    assert board.outline.equals(other.outline)
    assert [(c.taxel, c.net) for c in board.combs] == [(c.taxel, c.net) for c in other.combs]
    shapes = [[comb.shape.normalize() for comb in one.combs] for one in (board, other)]
    assert shapes[0] == shapes[1]
    assert [(q.net, q.layer, q.width) for q in board.pieces] == [(q.net, q.layer, q.width) for q in other.pieces]
    np.testing.assert_array_equal([q.ends for q in board.pieces], [q.ends for q in other.pieces])
    assert [net for net, _ in board.vias] == [net for net, _ in other.vias]
    np.testing.assert_array_equal([place for _, place in board.vias], [place for _, place in other.vias])
    np.testing.assert_array_equal(board.contacts, other.contacts)


def test_the_boards_of_a_pair_are_mirror_images(boards):
    (_, _, left, _), (_, _, right, _) = boards
    _same_board(mirrored_board(left), right)
    _same_board(mirrored_board(mirrored_board(left)), left)
    flip = np.array([1.0, -1.0])
    for k, net in enumerate(right.tail):  # a contact's number counts from the tail's other edge
        at = left.tail.index(net)
        assert at == len(left.tail) - 1 - k
        np.testing.assert_array_equal(right.contacts[k], left.contacts[at] * flip)


def test_lines_that_find_no_way_on_one_hand_are_led_as_on_the_other():
    """A box, on whose right sheet all lines find their ways at once, and on its left one not in 40 orders."""
    foot = foot_from_dimensions("a", length=0.22, width=0.09, corner_radius=0.01, sole_center=(0.02, 0.0), mass=20.0)
    build = build_shoe(foot, cell=read_cell("velostat"), layout_only=True)
    left, right = (flex_board(shoe, build.parameters) for shoe in build.shoes)
    _same_board(mirrored_board(left), right)
    _problems(build.shoes[0], build, kicad_text(left))


def test_a_mirrored_foot_has_mirrored_layouts_and_boards(prism, stl):
    points = prism(np.array([[-45, -35], [55, -35], [75, -10], [75, 25], [65, 35], [-45, 35]], dtype=float), 0.0, 40.0)
    given = [stl(points, "left_foot.stl"), stl(points[:, ::-1] * [1.0, -1.0, 1.0], "right_foot.stl")]
    p = ShoeParameters(robot_mass=4.0)
    cell = read_cell("velostat")
    builds = [build_shoe(path, cell=cell, parameters=p, layout_only=True, name="a") for path in given]
    p = builds[0].parameters
    for shoe, other in zip(builds[0].shoes, builds[1].shoes, strict=True):
        np.testing.assert_array_equal(shoe.layout.positions, other.layout.positions)
        np.testing.assert_array_equal(shoe.layout.outline, other.layout.outline)
        _same_board(flex_board(shoe, p), flex_board(other, p))


@pytest.mark.long
@pytest.mark.parametrize(("length", "width", "mass"), [(0.2, 0.083, 33.0), (0.224, 0.147, 47.0)])
def test_larger_boards_hold_the_same(length, width, mass):
    foot = foot_from_dimensions("a", length=length, width=width, corner_radius=0.02, sole_center=(0.02, 0.0), mass=mass)
    build = build_shoe(foot, side="left", cell=read_cell("velostat"), layout_only=True)
    _problems(build.shoes[0], build, kicad_text(flex_board(build.shoes[0], build.parameters)))


def test_the_count_sees_what_is_broken(boards):
    _, _, board, _ = boards[0]
    cut = replace(board, pieces=tuple(p for p in board.pieces if p.net != "C1" or p.layer == 0))
    assert "C1" in count_board(kicad_text(cut)).open_nets
    piece = next(p for p in board.pieces if p.net == "R1" and np.hypot(*(p.ends[1] - p.ends[0])) > 5.0)
    close = replace(board, pieces=(*board.pieces, replace(piece, net="R2", ends=piece.ends + np.array([0.0, -0.3]))))
    assert count_board(kicad_text(close)).clearance < CLEARANCE
    wide = replace(board, outline=board.outline.buffer(-3.0))
    assert count_board(kicad_text(wide)).edge < EDGE


def test_combs_leave_a_gap_all_along(boards):
    row, column = comb_shapes(8.0)
    assert row.distance(column) == pytest.approx(0.3)
    assert row.union(column).bounds == pytest.approx((-3.85, -3.85, 3.85, 3.85), abs=0.3)


def _drc(path):
    """What KiCad's own rules find: by kicad-cli from 8 on, or the library of 6 and 7; None without."""
    if shutil.which("kicad-cli"):
        out = path.with_suffix(".rpt")
        done = subprocess.run(["kicad-cli", "pcb", "drc", "-o", str(out), str(path)], capture_output=True, check=False)
        return out.read_text() if done.returncode == 0 else None
    code = f"import pcbnew; b = pcbnew.LoadBoard({str(path)!r}); "
    code += f"pcbnew.WriteDRCReport(b, {str(path) + '.rpt'!r}, pcbnew.EDA_UNITS_MILLIMETRES, True)"
    done = subprocess.run(["/usr/bin/python3", "-c", code], capture_output=True, check=False, cwd=path.parent)
    return (path.parent / f"{path.name}.rpt").read_text() if done.returncode == 0 else None


@pytest.mark.long
def test_kicads_own_rules_find_nothing(boards, tmp_path):
    path = tmp_path / "board.kicad_pcb"
    path.write_text(boards[0][3])
    report = _drc(path)
    if report is None:
        pytest.skip("KiCad is not installed")
    assert "Found 0 unconnected" in report
    errors = re.findall(r"^\[(\w+)\]", report, re.MULTILINE)
    assert set(errors) <= {"track_dangling"}  # a row's end beyond its last comb, a warning


def test_gerbers_hold_the_copper_of_the_board(boards):
    _, _, board, _ = boards[0]
    data = gerber_zip(board)
    assert data == gerber_zip(board)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        files = {name: archive.read(name).decode() for name in archive.namelist()}
    assert set(files) == {
        "front_copper.gtl", "back_copper.gbl", "front_mask.gts", "back_mask.gbs", "outline.gko", "holes.drl",
    }  # fmt: skip
    assert files["front_copper.gtl"].count("G36*") == len(board.combs)
    assert files["front_copper.gtl"].count("D03*") == files["holes.drl"].count("X") == len(board.vias)
    assert all(text.rstrip().endswith(("M02*", "M30")) for text in files.values())


def test_another_programs_reader_sees_the_same_front(boards):
    gerbonara = pytest.importorskip("gerbonara")
    _, _, board, _ = boards[0]
    with zipfile.ZipFile(io.BytesIO(gerber_zip(board))) as archive:
        read = gerbonara.GerberFile.from_string(archive.read("front_copper.gtl").decode())
        holes = gerbonara.ExcellonFile.from_string(archive.read("holes.drl").decode())
    kinds = [type(thing).__name__ for thing in read.objects]
    assert kinds.count("Region") == len(board.combs)
    assert kinds.count("Flash") == len(board.vias) == len(holes.objects)
    (x0, y0), (x1, y1) = read.bounding_box(unit=gerbonara.utils.MM)
    low_x, low_y, high_x, high_y = board.outline.bounds
    assert low_x < x0 < x1 < high_x
    assert -high_y < y0 < y1 < -low_y
