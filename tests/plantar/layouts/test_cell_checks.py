"""Layout files whose cells contradict themselves are refused in one line that names the taxel."""

import copy
from dataclasses import replace

import pytest

from plantar import grid_layout, hex_layout, laid_over, layout_of_cells, write_layout
from plantar.errors import InputError, LayoutError
from plantar.layouts.layout_file import layout_from_dict, layout_to_dict

SOLE = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.05, 0.05))


def swapped(rotation):
    return [rotation[0], [-v for v in rotation[1]], [-v for v in rotation[2]]]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda s: s.update(units="cm, N, degC"), "field 'units' is 'cm, N, degC'; allowed: m, N, degC"),
        (lambda s: s["taxels"][3].update(area=0.01), "field 'area' of taxel 3 is 0.01 m"),
        (lambda s: s["taxels"][2].update(position=[1.0, 0.0, 0.0]), "field 'position' of taxel 2 lies beside its cell"),
        (lambda s: s["taxels"][1]["corners"].reverse(), "taxel 1 goes round 'vertices' clockwise"),
        (lambda s: s["taxels"][1].update(corners=[s["taxels"][1]["corners"][i] for i in (0, 2, 1, 3)]), "cross itself"),
        (
            lambda s: s["taxels"][0].update(rotation_taxel_to_sole=swapped(s["taxels"][0]["rotation_taxel_to_sole"])),
            "of taxel 0 points out of the body",
        ),
    ],
)
def test_a_contradiction_is_refused(change, words):
    source = copy.deepcopy(layout_to_dict(SOLE))
    change(source)
    with pytest.raises(LayoutError, match=words) as caught:
        layout_from_dict(source)
    assert "\n" not in str(caught.value)


def test_curved_and_cut_cells_are_right():
    outline = [[-0.08, -0.04], [0.15, -0.05], [0.16, 0.03], [-0.08, 0.04]]
    flat = hex_layout(outline)
    for layout in (flat, laid_over(flat, lambda x, y: 2.0 * x**2 + y**2)):
        assert len(layout_from_dict(layout_to_dict(layout))) == len(layout)


def test_what_is_no_layout_is_not_written(tmp_path):
    with pytest.raises(InputError, match="layout"):
        write_layout("x", tmp_path / "x.json")
    assert len(repr(SOLE)) < 100


def test_what_could_not_be_read_again_is_not_written(tmp_path):
    beside = layout_of_cells([SOLE.cell_polygon(0)], positions=[[0.5, 0.5]])
    for layout, words in ((replace(SOLE, areas=2.0 * SOLE.areas), "'area'"), (beside, "'position' of taxel 0")):
        with pytest.raises(LayoutError, match=words):
            write_layout(layout, tmp_path / "sole.json")
    assert not list(tmp_path.iterdir())
