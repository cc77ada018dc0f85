"""Messages that a template fills are what Foxglove's own package decodes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.recordings.foxglove import Template, cube, entity, frame_transform, message_of, pose, slot

FrameTransforms = pytest.importorskip("foxglove_schemas_protobuf.FrameTransforms_pb2").FrameTransforms
Log = pytest.importorskip("foxglove_schemas_protobuf.Log_pb2").Log
SceneUpdate = pytest.importorskip("foxglove_schemas_protobuf.SceneUpdate_pb2").SceneUpdate

NUMBERS = st.floats(allow_nan=False)
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


@given(st.tuples(NUMBERS, NUMBERS), st.integers(0, 10**18))
def test_values_and_time_come_back_as_they_were_filled_in(values, nanoseconds):
    template = Template(frame_transform("sole", (slot(1), slot(0), 4.5), UPRIGHT))
    (found,) = FrameTransforms.FromString(template.filled(nanoseconds * 1e-9, values)).transforms
    assert (found.translation.y, found.translation.x, found.translation.z) == (*values, 4.5)
    assert found.timestamp.ToNanoseconds() == round(nanoseconds * 1e-9 * 1e9)


@given(st.text(max_size=300), st.lists(NUMBERS, min_size=7, max_size=7))
def test_names_and_fixed_numbers_are_read_as_they_were_written(name, numbers):
    box = cube(pose(numbers[:3]), numbers[3:6], (numbers[6], 0.0, 0.0, 1.0))
    (found,) = SceneUpdate.FromString(Template(entity(name, name, box, locked=False)).filled(0.0)).entities
    (read,) = found.cubes
    assert (found.id, found.frame_id, found.frame_locked) == (name, name, False)
    assert [read.pose.position.x, read.pose.position.y, read.pose.position.z] == numbers[:3]
    assert [read.size.x, read.size.y, read.size.z, read.color.r] == numbers[3:]


def test_what_the_library_writes_is_read():
    log = Log(level="ERROR", message="fell", line=7)
    log.timestamp.FromNanoseconds(1_500_000_000)
    found = message_of("foxglove.Log", log.SerializeToString())
    assert (found.level, found.message, found.line) == (4, "fell", 7)
    assert (found.timestamp.seconds, found.timestamp.nanos) == (1, 500_000_000)


def test_values_are_read_back_of_messages_that_a_template_filled():
    parts = (
        frame_transform("torso", (slot(1), slot(0), 7.0), UPRIGHT),
        frame_transform("sole", (0.0, 0.0, slot(2)), UPRIGHT),
    )
    template, rows = Template(*parts), np.arange(6.0).reshape(2, 3)
    messages = [bytes(message) for message in template.filled_all([5, 10**9], rows)]
    assert messages == [template.filled(5e-9, rows[0]), template.filled(1.0, rows[1])]
    assert template.values_of(messages).tolist() == rows.tolist()
    with pytest.raises(ValueError, match="another template"):
        template.values_of([messages[0] + b"x"])


def test_as_many_slots_as_a_sole_of_a_thousand_taxels_has():
    boxes = [cube(pose((slot(3 * i), slot(3 * i + 1), slot(3 * i + 2))), (1.0,) * 3, (1.0,) * 4) for i in range(1000)]
    template, wanted = Template(entity("sole", "sole", *boxes)), np.random.default_rng(1).normal(size=3000)
    (found,) = SceneUpdate.FromString(template.filled(0.0, wanted)).entities
    places = [[c.pose.position.x, c.pose.position.y, c.pose.position.z] for c in found.cubes]
    assert np.ravel(places).tolist() == wanted.tolist()


def test_a_filled_message_leaves_its_template_alone():
    template = Template(frame_transform("sole", (slot(0),) * 3, UPRIGHT))
    first = template.filled(0.0, [1.0])
    assert template.filled(0.0, [2.0]) != first
    assert template.filled(0.0, [1.0]) == first


@pytest.mark.parametrize(
    "message", [b"\x09\x00", b"\x0a\x05ab", b"\x0b", b"\x08", b"\x08" + b"\xff" * 11, bytes(10_000_001)]
)
def test_what_is_cut_short_or_too_large_is_an_error(message):
    with pytest.raises(ValueError, match="message"):
        message_of("foxglove.FrameTransforms", message)
