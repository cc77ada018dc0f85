"""The papers' experiments open as written, as ours and without; their figures are those that runs report."""

import pytest
from paper_experiments import EXPERIMENTS, PaperExperiment, figure_of

from plantar.errors import PlantarError
from plantar.sim.run.scene_kind import open_scene


@pytest.mark.parametrize("one", EXPERIMENTS, ids=lambda e: e.name)
def test_every_experiment_opens_in_each_variant(one: PaperExperiment) -> None:
    for settings in ((f"paper={one.source[0]}",), one.settings, (*one.settings, *one.without)):
        opened = open_scene(one.scene, settings, one.robot or None)
        assert one.robot in ("", opened.robot)


def test_figures_of_a_run() -> None:
    summary = {
        "impacts_N": [1.0, 2.0, 3.0, 4.0, 10.0],
        "steps_taken": 8,
        "push": {"pushes": [{}] * 16},
        "reasons": [{"criterion": "strides", "value": 8, "limit": 16}],
        "balance": {"skin_against_force_torque": {"max_m": 0.0021}},
        "force_rms_disturbed_N": 0.3,
    }
    names = ("mean impact", "largest impact", "impact on the slab", "steps", "strides", "largest difference")
    assert [figure_of(name, summary) for name in names] == [4.0, 10.0, 10.0, 8.0, 8.0, 2.1]
    assert figure_of("strides", summary | {"reasons": []}) == 16.0
    assert figure_of("force_rms_disturbed_N", summary) == 0.3
    assert figure_of("impact on the slab", {"impacts_N": []}) is None
    with pytest.raises(PlantarError, match="no figure is called 'weight'"):
        figure_of("weight", summary)
