"""The table of people above a walk, as StepUP-P150 has it."""

import pytest

from plantar.formats.step_table import masses_of_people


@pytest.mark.parametrize(
    ("text", "masses"),
    [
        ("ParticipantID,Weight (Kg)\n1,70.5\n2,80\n", {"001": 70.5, "002": 80.0}),
        ("Weight (Kg),ParticipantID\n70.5,1\n80\n,3\n-2,4\n60,anna\n", {"001": 70.5}),
        ("ParticipantID,Height\n1,1.8\n", {}),
    ],
)
def test_masses_are_of_the_rows_that_state_both_a_person_and_a_mass(tmp_path, text, masses):
    (tmp_path / "participant_metadata.csv").write_text(text)
    walk = tmp_path / "001" / "BF" / "W1" / "walk.npz"
    assert masses_of_people(walk) == masses
