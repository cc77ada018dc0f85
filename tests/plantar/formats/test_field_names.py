"""Names of columns, as makers and people write them."""

import pytest

from plantar.formats.field_names import heading_of, spelled_out


@pytest.mark.parametrize(
    ("name", "quantity", "axis", "side", "number", "unit"),
    [
        ("Fz1_V", "force", "z", None, 1, "V"),
        ("F1Z_mV", "force", "z", None, 1, "mV"),
        ("GRF_V", "force", "vertical", None, None, ""),
        ("leftforce", "force", "", "left", None, ""),
        ("FZL", "force", "z", "left", None, ""),
        ("rfoot_vGRF", "force", "", "right", None, ""),
        ("RTOE", "cell", "", "right", None, ""),
        ("LTOE[0]", "foreign", "", "left", 0, ""),
        ("LTOE_X", "foreign", "x", "left", None, ""),
        ("LHEE[0]", "unknown", "", None, 0, ""),
        ("Left wheel Fz (N)", "foreign", "z", "left", None, "N"),
        ("f1_1", "force", "", None, 1, ""),
        ("Carga izquierda [kg]", "force", "", "left", None, "kg"),
        ("forms", "unknown", "", None, None, ""),
    ],
)
def test_names(name, quantity, axis, side, number, unit):
    found = heading_of(name)
    assert (found.quantity, found.axis, found.side, found.number, found.unit) == (quantity, axis, side, number, unit)


def test_no_word_is_found_within_another():
    assert {heading_of(word).quantity for word in ("coefficient", "sampler", "pedals", "lateness", "marches")} == {
        "unknown"
    }


def test_names_of_another_program_are_spelled_out_where_all_axes_are_there():
    assert spelled_out(["f1_1", "f1_2"]) == ["f1_1", "f1_2"]
    assert spelled_out(["f1_1", "f1_2", "f1_3", "p2_3"]) == ["FP1 Fx", "FP1 Fy", "FP1 Fz", "FP2 COPz"]
