"""Foxglove's own package describes the same schemas and reads the same messages."""

import sys

import pytest

from plantar.recordings import foxglove
from plantar.recordings.foxglove import Template, slot

FrameTransforms = pytest.importorskip("foxglove_schemas_protobuf.FrameTransforms_pb2").FrameTransforms
LinePrimitive = pytest.importorskip("foxglove_schemas_protobuf.LinePrimitive_pb2").LinePrimitive
Log = pytest.importorskip("foxglove_schemas_protobuf.Log_pb2").Log
SceneEntityDeletion = pytest.importorskip("foxglove_schemas_protobuf.SceneEntityDeletion_pb2").SceneEntityDeletion
SceneUpdate = pytest.importorskip("foxglove_schemas_protobuf.SceneUpdate_pb2").SceneUpdate

RED = (1.0, 0.0, 0.25, 0.5)


@pytest.mark.parametrize("schema", foxglove.SCHEMAS)
def test_a_recording_carries_the_descriptors_that_the_package_has(schema, repository, monkeypatch):
    monkeypatch.syspath_prepend(str(repository / "tools"))
    from foxglove_schemas import descriptor_set

    sys.modules.pop("foxglove_schemas")
    assert foxglove.descriptor(schema) == descriptor_set(schema)


def test_a_frame_transform():
    slots = [slot(i) for i in range(7)]
    message = Template(foxglove.frame_transform("pelvis", slots[:3], slots[3:])).filled(2.25, [1, 2, 3, 0, 0, 0.6, 0.8])
    (found,) = FrameTransforms.FromString(message).transforms
    assert (found.parent_frame_id, found.child_frame_id) == ("world", "pelvis")
    assert (found.translation.x, found.translation.y, found.translation.z) == (1, 2, 3)
    assert (found.rotation.z, found.rotation.w) == (0.6, 0.8)
    assert found.timestamp.ToNanoseconds() == 2_250_000_000


def test_an_entity_of_every_primitive():
    place = foxglove.pose((0.1, 0.2, 0.3), (0.0, 0.6, 0.0, 0.8))
    parts = (
        foxglove.cube(place, (1.0, 2.0, 3.0), RED),
        foxglove.sphere(place, (1.0, 1.0, 2.0), RED),
        foxglove.cylinder(place, (1.0, 1.0, 4.0), RED),
        foxglove.arrow(place, 0.5, 0.02, RED),
        foxglove.line_loop([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)], 0.01, RED),
        foxglove.triangles([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)], [[0, 1, 2]], RED),
        foxglove.words(place, "7", 0.1, RED),
    )
    message = Template(foxglove.delete_all(), foxglove.entity("all", "sole_left", *parts)).filled(0.5)
    update = SceneUpdate.FromString(message)
    assert update.deletions[0].type == SceneEntityDeletion.ALL
    (found,) = update.entities
    assert (found.id, found.frame_id, found.frame_locked) == ("all", "sole_left", True)
    assert found.timestamp.ToNanoseconds() == 500_000_000
    cube, sphere, cylinder, arrow = found.cubes[0], found.spheres[0], found.cylinders[0], found.arrows[0]
    for primitive in (cube, sphere, cylinder, arrow, found.texts[0]):
        assert (primitive.pose.position.z, primitive.pose.orientation.w) == (0.3, 0.8)
        assert (primitive.color.r, primitive.color.b, primitive.color.a) == (1.0, 0.25, 0.5)
    assert (cube.size.z, sphere.size.z, cylinder.size.z) == (3.0, 2.0, 4.0)
    assert (cylinder.top_scale, cylinder.bottom_scale) == (1.0, 1.0)
    assert (arrow.shaft_length, arrow.shaft_diameter, arrow.head_diameter) == (0.5, 0.02, 0.04)
    (line,), (mesh,) = found.lines, found.triangles
    assert line.pose.orientation.w == mesh.pose.orientation.w == 1.0  # a viewer may take none for a quaternion of zeros
    assert (line.type, len(line.points), line.thickness) == (LinePrimitive.LINE_LOOP, 3, 0.01)
    assert (list(mesh.indices), len(mesh.points), mesh.color.a) == ([0, 1, 2], 3, 0.5)
    assert (found.texts[0].text, found.texts[0].billboard) == ("7", True)


@pytest.mark.parametrize("level", foxglove.LEVELS)
def test_a_log_message(level):
    found = Log.FromString(foxglove.log_message(3.125, "step 3: foothold seen", level, "plan"))
    assert Log.Level.Name(found.level) == level.upper()
    assert (found.message, found.name, found.timestamp.ToNanoseconds()) == (
        "step 3: foothold seen",
        "plan",
        3_125_000_000,
    )
