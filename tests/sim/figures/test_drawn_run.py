"""What viewers draw of a run is what the rest of its recording says, in messages that Foxglove's package reads."""

import json
from collections import defaultdict
from typing import Any

import numpy as np
import pytest
import shapely
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from mcap.reader import make_reader

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.sides import SIDES
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.plan_change import AppliedChange, MovedStep, PlanChange
from plantar.mechanics.rotation import level_rotation
from plantar.recordings.recording import Recording, read_mcap
from plantar.sim.figures.drawn_run import change_text
from plantar.sim.run.runner import run_scene
from plantar.sim.run.scene import load_scene

TYPES = {"foxglove.FrameTransforms": FrameTransforms, "foxglove.SceneUpdate": SceneUpdate, "foxglove.Log": Log}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    """Two steps, the right one onto an edge that is seen only then."""
    path = tmp_path_factory.mktemp("drawn") / "run.mcap"
    run_scene(load_scene("partial-inner", ["steps=3", "settle=0.1", "begin=1"]), 0, record=path)
    return path


@pytest.fixture(scope="module")
def run(path):
    return read_mcap(path)


@pytest.fixture(scope="module")
def drawn(path):
    """Time and message of each topic of Foxglove's."""
    found = defaultdict(list)
    with path.open("rb") as stream:
        for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            assert schema is not None
            if schema.encoding == "protobuf":
                assert channel.message_encoding == "protobuf"
                found[channel.topic].append((message.log_time, TYPES[schema.name].FromString(message.data)))
    return found


def at(run: Recording, topic: str, field: str, time: int) -> np.ndarray:
    """A recorded value at a time in ns."""
    table = run.topics[topic]
    (row,) = np.flatnonzero(np.abs(table.time - time * 1e-9) < 1e-6)[-1:]
    return table.fields[field][row]


def test_every_topic_is_there_and_readers_of_numbers_pass_over_them(run, drawn):
    assert set(drawn) == {"/tf", "/log", *(f"/scene/{name}" for name in ("world", "soles", "balance", "footsteps"))}
    assert not run.warnings
    assert not set(run.topics) & set(drawn)


def test_messages_state_the_time_at_which_they_are_logged(drawn):
    for name, field in (("/tf", "transforms"), ("/scene/soles", "entities"), ("/scene/footsteps", "entities")):
        for time, message in drawn[name]:
            assert {part.timestamp.ToNanoseconds() for part in getattr(message, field)} == {time}
    assert all(message.timestamp.ToNanoseconds() == time for time, message in drawn["/log"])


def test_soles_and_center_of_mass_are_where_they_truly_are(run, drawn):
    assert np.diff([time for time, _ in drawn["/tf"]]) == pytest.approx(20e6)
    for time, message in drawn["/tf"][::20]:
        frames = {t.child_frame_id: t for t in message.transforms}
        for side in SIDES:
            frame = frames[f"sole_{side}"]
            place = [getattr(frame.translation, axis) for axis in "xyz"]
            assert place == pytest.approx(at(run, f"/truth/{side}", "position", time), abs=1e-12)
            x, y, z, w = (getattr(frame.rotation, axis) for axis in "xyzw")
            forward = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)]
            matrix = at(run, f"/truth/{side}", "rotation", time).reshape(3, 3)
            assert forward == pytest.approx(matrix[:, 0], abs=1e-9)
        com = frames["center_of_mass"].translation
        assert [com.x, com.y, com.z] == pytest.approx(at(run, "/truth/body", "com", time), abs=1e-12)


def test_every_entity_has_a_frame_that_is_known(drawn):
    frames = {"world"} | {t.child_frame_id for _, message in drawn["/tf"] for t in message.transforms}
    ((time, shapes),) = drawn["/scene/world"]
    assert time == drawn["/tf"][0][0]
    assert {entity.frame_id for entity in shapes.entities} == frames - {"sole_left", "sole_right", "center_of_mass"}
    for topic in ("/scene/soles", "/scene/balance", "/scene/footsteps"):
        assert {entity.frame_id for _, message in drawn[topic] for entity in message.entities} <= frames


def test_taxels_are_coloured_by_force_and_the_force_stands_at_its_center(run, drawn):
    for time, message in drawn["/scene/soles"][::10]:
        entities = {entity.id: entity for entity in message.entities}
        for side in SIDES:
            read = max(0, time - 4_000_000)  # the reading that has arrived by now: a sample of 4 ms ago
            force = at(run, f"/skin/{side}", "force", read)
            taxels = entities[f"taxels {side}"].cylinders
            brightness = np.array([0.299 * t.color.r + 0.587 * t.color.g + 0.114 * t.color.b for t in taxels])
            assert len(taxels) == len(force)
            assert (np.diff(brightness[np.argsort(force)]) >= -1e-12).all()
            centers = np.array([[t.pose.position.x, t.pose.position.y] for t in taxels])
            assert np.abs(centers - run.layouts[side].positions[:, :2]).max() < 8e-3  # cells at the edge are clipped
            ball, arrow = entities[f"CoP {side}"].spheres[0], entities[f"CoP {side}"].arrows[0]
            if force.sum() > 0.0:
                cop = force @ run.layouts[side].positions[:, :2] / force.sum()
                assert [ball.pose.position.x, ball.pose.position.y] == pytest.approx(cop, abs=1e-9)
            share = max(0.0, force.sum()) / REFERENCE_BODY.weight
            assert arrow.shaft_length == pytest.approx(0.5 * share * REFERENCE_BODY.leg, rel=0.01)


def test_the_margin_is_that_of_the_drawn_polygon(run, drawn):
    compared = 0
    for time, message in drawn["/scene/balance"]:
        entities = {entity.id: entity for entity in message.entities}
        ball, line = entities["ZMP"].spheres[0], entities["support polygon"].lines[0]
        if line.color.a == 0.0 or ball.color.a == 0.0:
            continue
        polygon = shapely.Polygon([(p.x, p.y) for p in line.points])
        point = shapely.Point(ball.pose.position.x, ball.pose.position.y)
        inside = polygon.boundary.distance(point) * (1 if polygon.covers(point) else -1)
        assert inside == pytest.approx(at(run, "/truth/body", "zmp_margin", time)[0], abs=1e-6)
        compared += 1
    assert compared > 0.9 * len(drawn["/scene/balance"])


def test_footsteps_are_drawn_again_with_each_change_which_the_log_explains(run, drawn):
    _, first = drawn["/scene/footsteps"][0]
    assert [entity.id for entity in first.entities] == ["footstep 0", "footstep 1", "footstep 2"]
    outline = run.layouts["left"].outline
    points = np.array([[p.x, p.y] for p in first.entities[0].lines[0].points])
    label = first.entities[0].texts[0]
    place = np.array([label.pose.position.x, label.pose.position.y])
    assert points - place == pytest.approx(outline @ level_rotation(0.0)[:2, :2].T, abs=1e-9)
    said = [message.message for _, message in drawn["/log"] if message.name == "plan"]
    assert said
    assert all(line.startswith("step ") for line in said)
    times = {time for time, _ in drawn["/scene/footsteps"]}
    assert {time for time, message in drawn["/log"] if message.name == "plan"} <= times


def test_chunks_are_smaller_by_more_than_a_quarter(path):
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    packed = sum(chunk.compressed_size for chunk in summary.chunk_indexes)
    assert packed < 0.75 * sum(chunk.uncompressed_size for chunk in summary.chunk_indexes)


def test_the_layout_for_foxglove_names_what_recordings_hold(repository, run, drawn):
    layout = json.loads((repository / "docs" / "foxglove_layout.json").read_text())
    panels = layout["configById"]

    def placed(node: Any) -> list[str]:
        return [node] if isinstance(node, str) else placed(node["first"]) + placed(node["second"])

    assert sorted(placed(layout["layout"])) == sorted(panels)
    frames = {t.child_frame_id for t in drawn["/tf"][0][1].transforms}
    for panel in panels.values():
        assert panel.get("followTf", "sole_left") in frames
        assert set(panel.get("topics", ())) <= set(drawn)
        assert panel.get("topicToRender", "/log") in drawn
        for path in panel.get("paths", ()):
            topic, field = path["value"].split(".")
            assert field in run.topics[topic].fields


def test_a_change_is_logged_with_its_reason_and_what_it_moved():
    before = Footstep("left", 0.6, 0.1)
    moved = MovedStep(3, 0.62, 0.095, 0.0, "ground refused", before), MovedStep(4, 0.9, -0.1, 0.0, "more", None)
    change = PlanChange("ground refused", 3, vrp=(0.5, 0.1), longer=-0.04)
    assert change_text(AppliedChange(1.0, change, moved, (0.0, 0.0), 0.1)) == (
        "step 3: ground refused; footstep 3 moved by +20 mm forward and -5 mm to the left; 1 new footstep(s); "
        "VRP at (0.500, 0.100) m; single support shorter by 40 ms; double support longer by 100 ms"
    )
    assert change_text(AppliedChange(1.0, PlanChange("strides learned", 2), (), (0.0, 0.0), 0.0)) == (
        "step 2: strides learned"
    )
