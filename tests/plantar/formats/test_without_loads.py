"""Files of the field that hold no loads: made by what their makers describe, with other numbers."""

import pytest

from plantar import FormatError
from plantar.formats import read_recording

_FILES = {
    "places of markers": "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\n90\t90\nFrame#\tTime\tRHE\n1\t0\t3\n",
    "counts of an A/D converter": "File_Type:\tAnalog R/C ASCII\nName\tF1X\tF1Z\nRate\t900\t900\n0.0\t12\t-7\n",
    "export with the section Devices": "Trajectories\n120\n,,S:LTOE,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,2,3,4\n",
}


@pytest.mark.parametrize("what", _FILES)
def test_text_without_loads_is_refused_with_what_to_give(tmp_path, what):
    path = tmp_path / "walk.txt"
    path.write_text(_FILES[what])
    with pytest.raises(FormatError, match=f"{what}.*") as refused:
        read_recording(path)
    assert "allowed: " in str(refused.value)


@pytest.mark.parametrize("sign", ",;")
def test_places_of_markers_saved_by_a_spreadsheet(tmp_path, sign):
    path = tmp_path / "walk.trc"
    path.write_text(_FILES["places of markers"].replace("\t", sign))
    with pytest.raises(FormatError, match="places of markers"):
        read_recording(path)


def test_places_of_markers_above_force_plates_are_read_on(tmp_path):
    path = tmp_path / "walk.csv"
    rows = "".join(f"{i},0,{400 * (10 < i % 60 < 40)}\n" for i in range(200))
    markers = "Trajectories\n100\n,,S:LTOE,,\nFrame,Sub Frame,X,Y,Z\n1,0,1,2,3\n\n"
    path.write_text(f"{markers}Devices\n1000\n,,Plate 1 - Force\nFrame,Sub Frame,Fz\n,,N\n{rows}")
    with pytest.raises(FormatError) as refused:
        read_recording(path)
    assert "places of markers" not in str(refused.value)


def test_a_binary_file_of_bts_is_named(tmp_path):
    path = tmp_path / "walk.tdf"
    path.write_bytes(bytes.fromhex("824b6041d31184ca6000b6ac16680c08") + bytes(600))
    with pytest.raises(FormatError, match="BTS file"):
        read_recording(path)
