"""A sweep's result in words."""

from plantar.sim.sweep.sweep_text import sweep_errors, sweep_text

RESULT = {
    "points": [
        {"settings": {"impulse": 20}, "runs": 3, "completed": 3, "reasons": {}, "errors": []},
        {"settings": {"impulse": 30}, "runs": 4, "completed": 1, "reasons": {"torque_limit": 2}, "errors": ["x", "x"]},
    ],
    "files": ["results.csv"],
}


def test_each_point_lists_what_was_completed_and_why_not():
    assert sweep_text(RESULT, "push").splitlines() == [
        "impulse=20: 3 of 3 completed",
        "impulse=30: 1 of 4 completed; failed by: torque limit 2",
        "  results.csv",
    ]


def test_an_error_is_listed_once_with_its_count():
    assert sweep_errors(RESULT, "push") == ["impulse=30: 2 run(s) could not be: x"]


def test_a_sweep_without_a_grid_is_called_by_its_scene():
    one = {"points": [RESULT["points"][0] | {"settings": {}, "errors": ["y"]}], "files": []}
    assert sweep_text(one, "push") == "push: 3 of 3 completed"
    assert sweep_errors(one, "push") == ["push: 1 run(s) could not be: y"]


def test_a_limit_that_no_one_curve_tells_is_doubted():
    told = {"settings": {}, "setting": "impulse", "unit": "N s", "range": [5.0, 60.0], "limit": 37.0, "rising": False}
    told |= {"interval": [34.0, 39.0], "reached": False, "runs": 491, "completed": 250, "errors": []}
    doubted = sweep_text({"limits": [told | {"agreement": 7e-13}], "files": []}, "push")
    assert "no single limit explains these runs (p = 7e-13)" in doubted
    assert "--grid" in doubted
    assert "no one limit" not in sweep_text({"limits": [told | {"agreement": 0.01}], "files": []}, "push")
