"""Masks: the ten regions by anatomy and polygons of a file, in steps, tables and means."""

import json

import numpy as np
import pytest
import shapely

from plantar.errors import InputError
from plantar.gait.analysis.analyse import analyse
from plantar.gait.analysis.custom import mask_measures
from plantar.gait.analysis.masks import TEN, masks_of, read_masks
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.results import write_analysis

from .walks import made_walk

HALVES = {"hind": [[0, 0], [0.5, 0], [0.5, 1], [0, 1]], "front": [[0.5, 0], [1, 0], [1, 1], [0.5, 1]]}


def analysed(text):
    return analyse(made_walk(strides=4).recording, choices=AnalysisOptions(masks=masks_of(text)))


def test_ten_regions_share_the_impulse_between_them():
    """Each cell of the print is in one region, heel behind midfoot behind metatarsals behind toes."""
    walk = analysed("ten")
    for gait in walk.feet.values():
        assert [name for name, _ in gait.masks.names] == [name for name, _ in TEN]
        for step in gait.steps:
            assert set(step.regions) == {name for name, _ in TEN}
            assert sum(own["impulse_percent"] for own in step.regions.values()) == pytest.approx(100.0, abs=1.0)
        places = gait.footprint.centres
        of = {name: places[gait.region[gait.region >= 0] == i] for i, (name, _) in enumerate(TEN)}
        assert of["heel_medial"][:, 0].max() < of["midfoot"][:, 0].min()
        assert of["midfoot"][:, 0].max() < of["metatarsal_3"][:, 0].min()
        across = [of[f"metatarsal_{n}"][:, 1].mean() for n in (1, 2, 3, 4, 5)]
        assert across == sorted(across, reverse=True)
        assert of["heel_medial"][:, 1].min() > of["heel_lateral"][:, 1].max()


def test_polygons_of_a_file_measure_as_those_of_a_script(tmp_path):
    (tmp_path / "masks.json").write_text(json.dumps(HALVES))
    lines = [f"{name},{u},{v}" for name, ring in HALVES.items() for u, v in ring]
    (tmp_path / "masks.csv").write_text("\n".join(["mask,u,v", *lines]))
    assert read_masks(tmp_path / "masks.json") == read_masks(tmp_path / "masks.csv")
    walk = analysed(str(tmp_path / "masks.csv"))
    by_hand = mask_measures(walk, HALVES)
    for side, gait in walk.feet.items():
        for step, own in zip(gait.steps, by_hand[side], strict=True):
            assert set(step.regions) == set(own)
            assert all(step.regions[name] == pytest.approx(own[name], rel=1e-9) for name in own)
        layout = gait.foot.layout
        # The front half of the insole, cell by cell from the frames.
        low = layout.vertices[:, 0].min()
        high = layout.vertices[:, 0].max()
        front = layout.positions[:, 0] > 0.5 * (low + high)
        step = gait.steps[1]
        load = gait.foot.force[step.contact.begin : step.contact.end][:, front].sum(axis=1)
        assert step.regions["front"]["peak_force_N"] == pytest.approx(load.max(), rel=1e-9)
    write_analysis(walk, tmp_path)
    assert set(walk.metrics["feet"]["left"]["regions"]) == {"hind", "front"}
    assert ",front," in (tmp_path / "regions.csv").read_text()
    assert "Front" in (tmp_path / "report.html").read_text()


def test_masks_may_overlap(tmp_path):
    rings = {"all": [[0, 0], [1, 0], [1, 1], [0, 1]], **HALVES}
    (tmp_path / "masks.json").write_text(json.dumps(rings))
    for step in analysed(str(tmp_path / "masks.json")).feet["left"].steps:
        whole = step.regions["all"]["impulse_Ns"]
        assert whole == pytest.approx(step.regions["hind"]["impulse_Ns"] + step.regions["front"]["impulse_Ns"])
    assert shapely.Polygon(rings["all"]).area == 1.0


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.csv", "mask,u\na,0\n", "has the columns mask, u and v; this one mask, u"),
        ("a.csv", "mask,u,v\na,0,x\n", r"a\.csv, line 2: allowed: a mask's name"),
        ("a.csv", "mask,u,v\na,0,0\na,1,0\n", "mask a crosses itself, has less than three corners"),
        ("a.json", '{"a": [[0, 0], [1, 1], [1, 0], [0, 1]]}', "mask a crosses itself"),
        ("a.json", '{"a": [0, 1]}', r"mask a: allowed: corners \[u, v\]"),
        ("a.json", '{"a.b": []}', r"mask 'a\.b'; allowed: a name of letters"),
        ("a.json", "[]", "allowed: an object of 1 to 60 masks"),
    ],
)
def test_a_file_that_is_no_masks_is_refused(tmp_path, name, text, message):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=message):
        masks_of(str(tmp_path / name))


def test_a_word_that_is_no_mask_is_refused():
    with pytest.raises(InputError, match="--masks nine: no such file; allowed: seven, ten, or a file"):
        masks_of("nine")
    assert np.unique([name for name, _ in masks_of("seven").names]).size == 7
