"""Messages are decoded by protobuf's own library as what they were meant to be."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.recordings.foxglove import (
    Slot,
    Template,
    double,
    fixed32s,
    integer,
    nested,
    numbers,
    raw,
    read_fields,
    text,
    timestamp,
)

Log = pytest.importorskip("foxglove_schemas_protobuf.Log_pb2").Log
Vector3 = pytest.importorskip("foxglove_schemas_protobuf.Vector3_pb2").Vector3
Timestamp = pytest.importorskip("google.protobuf.timestamp_pb2").Timestamp

NUMBERS = st.floats(allow_nan=False)


@given(st.tuples(NUMBERS, NUMBERS), st.integers(0, 10**18))
def test_values_and_time_come_back_as_they_were_filled_in(values, nanoseconds):
    template = Template(timestamp(1), nested(2, double(2, Slot(1)), double(1, Slot(0)), double(3, 4.5)))
    fields = dict(read_fields(template.filled(nanoseconds * 1e-9, values)))
    time, vector = Timestamp.FromString(fields[1]), Vector3.FromString(fields[2])
    assert (vector.x, vector.y, vector.z) == (*values, 4.5)
    assert time.seconds * 10**9 + time.nanos == round(nanoseconds * 1e-9 * 1e9)


@given(st.integers(0, 2**32 - 1), st.text(max_size=300), st.lists(st.integers(0, 2**32 - 1), max_size=9))
def test_other_fields_are_read_as_they_were_written(number, words, four_bytes):
    message = Template(integer(2, number), text(3, words), fixed32s(900, four_bytes), raw(5, b"\x00\xff")).filled(0.0)
    fields = dict(read_fields(message))
    assert fields[2] == number
    assert fields[3] == words.encode()
    assert fields[5] == b"\x00\xff"
    packed = fields[900]
    assert isinstance(packed, bytes)
    assert list(struct.unpack(f"<{len(four_bytes)}I", packed)) == four_bytes


def test_what_the_library_writes_is_read():
    log = Log(level="ERROR", message="fell", line=7)
    log.timestamp.FromNanoseconds(1_500_000_000)
    fields = dict(read_fields(log.SerializeToString()))
    assert (fields[2], fields[3], fields[6]) == (4, b"fell", 7)
    assert dict(read_fields(fields[1])) == {1: 1, 2: 500_000_000}


def test_values_are_read_back_of_messages_that_a_template_filled():
    template = Template(text(1, "torso"), double(2, Slot(1)), timestamp(3), numbers(4, [Slot(0), 7.0, Slot(2)]))
    rows = np.arange(6.0).reshape(2, 3)
    messages = [bytes(message) for message in template.filled_all([5, 10**9], rows)]
    assert messages == [template.filled(5e-9, rows[0]), template.filled(1.0, rows[1])]
    assert template.values_of(messages).tolist() == rows.tolist()
    with pytest.raises(ValueError, match="another template"):
        template.values_of([messages[0] + b"x"])


def test_a_filled_message_leaves_its_template_alone():
    template = Template(numbers(1, [Slot(0), Slot(0)]))
    first = template.filled(0.0, [1.0])
    assert template.filled(0.0, [2.0]) != first
    assert template.filled(0.0, [1.0]) == first


@pytest.mark.parametrize("message", [b"\x09\x00", b"\x0a\x05ab", b"\x0b", b"\x08", b"\x08" + b"\xff" * 11])
def test_what_is_cut_short_or_unknown_is_an_error(message):
    with pytest.raises((ValueError, struct.error)):
        list(read_fields(message))
