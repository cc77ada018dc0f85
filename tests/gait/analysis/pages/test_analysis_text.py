"""An analysis in words."""

from plantar.gait.analysis.pages.report import analysis_text

WALK = {
    "format": "mcap",
    "frames": 100,
    "rate_hz": 50.0,
    "feet": {
        "left": {"steps": 3, "measures": {"contact_time_s": {"mean": 0.61}}},
        "right": {"steps": 0, "measures": {"contact_time_s": {"mean": None}}},
    },
    "gait": {"cadence_steps_per_min": 55.0},
    "warnings": ["told apart"],
}


def test_a_walk_tells_steps_contact_and_cadence():
    assert analysis_text(WALK).splitlines() == [
        "mcap: 100 frame(s) at 50 Hz",
        "  left: 3 complete steps, contact 0.610 s",
        "  right: 0 complete steps",
        "  cadence 55.0 steps/min",
    ]
    assert analysis_text(WALK, "A").startswith("A: mcap")


def test_standing_is_given_as_the_reason_why_there_are_no_steps():
    why = "no foot is lifted"
    standing = WALK | {"gait": {}, "activity": {"name": "standing", "why": why}}
    assert analysis_text(standing).splitlines()[-1] == f"  this is standing, in which no steps are counted: {why}"
    walking = WALK | {"activity": {"name": "walking", "why": why}}
    assert why not in analysis_text(walking)


def test_a_footprint_tells_what_was_measured_of_it():
    feet = {
        "left": {"footprint": {"length_m": 0.25, "arch_index": 0.231}},
        "right": {"footprint": {"length_m": None, "arch_index": None}},
    }
    image = {"format": "png", "frames": 1, "rate_hz": None, "feet": feet, "gait": {}, "warnings": []}
    assert analysis_text(image).splitlines() == [
        "png: 1 frame(s)",
        "  left footprint: 250 mm long, arch index 0.231",
        "  right footprint: arch index -",
    ]
