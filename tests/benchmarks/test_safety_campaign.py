"""Faults of the campaign change what they name alone, and its page counts what ran."""

import sys
from pathlib import Path

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.command import Sensors
from plantar.sensing.reading import Reading


@pytest.fixture
def benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "benchmarks"))
    yield
    for name in ("campaign_faults", "campaign_page"):
        sys.modules.pop(name, None)


def sensors(time):
    rng = np.random.default_rng(round(1000 * time))
    readings = {side: Reading(time, 20.0 + rng.normal(size=42)) for side in SIDES}
    return Sensors(time, 0.3 + 0.01 * rng.normal(size=12), rng.normal(size=3), np.array([0.1, 0.2, 9.8]), readings)


OWN = {"time": "time", "encoders": "joint_positions", "IMU": "gyro accelerometer", "soles": "readings"}
"""Fields of a reading that faults of a group change."""


def test_each_fault_changes_the_fields_of_its_group_alone(benchmarks):
    from campaign_faults import SINGLE

    assert len(SINGLE) == 120
    for name, part in SINGLE.items():
        fault = part.made()
        changed = set()
        for k in range(60):
            given = sensors(0.005 * k)
            seen = fault(given, 0.005 * k)
            if part.group != "all":
                changed |= {f for f in Sensors.__struct_fields__ if getattr(seen, f) is not getattr(given, f)}
        assert changed <= set(OWN.get(part.group, "").split()), name
        assert changed or part.group in ("all", "loop", "drives"), name


def test_reasons_are_of_faults_that_come_alone(benchmarks):
    from campaign_faults import SINGLE, WHY_LATE

    assert set(WHY_LATE) <= set(SINGLE)


def test_pairs_are_of_two_groups_and_drawn_once(benchmarks):
    from campaign_faults import PAIRS, SINGLE, drawn_pairs, parts_of

    assert len(PAIRS) == 60
    for name, (one, other) in PAIRS.items():
        assert SINGLE[one].group != SINGLE[other].group
        assert parts_of(name) == [SINGLE[one], SINGLE[other]]
    assert drawn_pairs(60, 69) == list(PAIRS.values())


def test_a_taxel_is_left_out_where_the_fault_is(benchmarks):
    from campaign_faults import SINGLE, places_of

    part = SINGLE["a left taxel reads 600 N"]
    seen = part.made()(sensors(0.0), 0.0).readings["left"].force
    sides, places = part.places
    assert sides == ("left",)
    assert np.flatnonzero(seen == 600.0).tolist() == places_of(seen, places).tolist()


def row(fell=None, named=0.1, stiffness=0.0, moves=(0.001, 0.002)):
    return {"fell": fell, "named": named, "stiffness": stiffness, "moves": moves, "raised": 0, "last": None}


def test_the_page_counts_falls_names_and_what_knowledge_would_have_saved(benchmarks):
    from campaign_page import counted, survivors

    rows = {
        "no IMU|h1|0": row(),
        "no IMU|h1|1": row(fell=1.0),
        "no IMU|h1|1|stop": row(),
        "no IMU|h1|2": row(fell=1.0, named=1.4, stiffness=1.0),
        "no IMU|h1|2|stop": row(fell=2.0),
        "no IMU|h1|3": row(named=None, moves=(0.003, 0.002)),
    }
    known = survivors(rows)
    assert known == {"no IMU|h1|1": True, "no IMU|h1|2": False}
    plain = {key: row for key, row in rows.items() if key.count("|") == 2}
    fell, down, kept, stiff, late, soon, never, raised, far = counted(plain, known, {"h1": (0.001, 0.002)})
    assert fell.startswith("2/4 ")
    assert kept.startswith("2/3 ")  # of one that fell, knowledge saved none
    assert soon.startswith("2/4 ")
    assert (down, stiff, late, never, raised, far) == ("0", "1", "1", "1", "0", "1")
