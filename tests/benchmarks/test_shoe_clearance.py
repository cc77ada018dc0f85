"""The clearance of a shoe from a link, against a ball that swings over a plate."""

import math

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")
pytest.importorskip("mujoco")

from shoe_clearance import FAR, Robot, clearance  # noqa: E402

from plantar.layouts.source_pose import SourcePose  # noqa: E402

MODEL = """<mujoco><worldbody><body name="shank"><freejoint/><geom size="0.01" pos="0.1 0 0.05"/>
<body name="ankle"><joint axis="0 1 0" range="-{swing} {swing}"/><geom size="0.001" pos="0 0 0.03"/>
<body name="foot"><joint axis="1 0 0" range="-20 20"/><geom type="box" size="0.1 0.05 0.005" pos="0 0 -0.02"/>
</body></body></body></worldbody></mujoco>"""


@pytest.mark.parametrize(("swing", "far"), [(30, False), (15, True)])
def test_the_nearest_pose_of_a_swinging_ball_is_found(swing, far, tmp_path):
    file = tmp_path / "leg.xml"
    file.write_text(MODEL.format(swing=swing))
    plate = trimesh.creation.box(extents=(300.0, 100.0, 2.0))
    plate.apply_translation((0.0, 0.0, -19.0))
    pose = SourcePose("leg.xml", "foot", np.zeros(3), np.eye(3))
    found = clearance(Robot(file, "foot"), {"print": np.array(plate.triangles)}, pose)
    lowest = -100.0 * math.sin(math.radians(swing)) + 50.0 * math.cos(math.radians(swing)) - 10.0
    if far:
        assert lowest + 18.0 > FAR
        assert (found.distance, found.link) == (FAR, "")
        return
    assert found.distance == pytest.approx(lowest + 18.0, abs=0.25)
    assert (found.body, found.link) == ("print", "shank")
    assert found.angles[1] == pytest.approx(-swing, abs=1.0)
    assert found.gap == pytest.approx(0.0, abs=0.6)
