import contextlib
import copy
import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar import InputError, LayoutError, hex_layout, mirrored, read_layout, write_layout
from plantar.layouts.layout_file import SCHEMA, layout_from_dict, layout_to_dict

FIELDS = ("positions", "rotations", "vertices", "areas", "outline", "ids")
PLAIN = ("name", "side", "corners", "neighbours", "cell_shape", "cell_area", "modalities", "ranges", "thresholds")

SMALL = layout_to_dict(hex_layout([[0, 0], [0.09, 0], [0.1, 0.05], [0, 0.05]], cell_area=691e-6))
assert len(SMALL["taxels"]) > 2


def assert_same(one, other):
    for name in FIELDS:
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name
    for name in PLAIN:
        assert getattr(one, name) == getattr(other, name), name


def test_round_trip_is_exact_to_the_last_bit(sole, tmp_path):
    for layout in (sole, mirrored(sole)):
        assert_same(layout, read_layout(write_layout(layout, tmp_path / "layout.json")))


@given(st.integers(0, 2**32 - 1))
def test_round_trip_of_any_place_on_the_sole(seed):
    rng = np.random.default_rng(seed)
    outline = np.array([[0, 0], [0.09, 0], [0.1, 0.05], [0, 0.05]]) + rng.normal(size=2)
    layout = hex_layout(outline, cell_area=rng.uniform(2e-4, 8e-4), angle=rng.uniform(-3, 3), minimum_fraction=0.1)
    assert_same(layout, layout_from_dict(json.loads(json.dumps(layout_to_dict(layout)))))


def test_writing_twice_gives_the_same_bytes(sole, tmp_path):
    one = write_layout(sole, tmp_path / "one.json").read_bytes()
    assert one == write_layout(read_layout(tmp_path / "one.json"), tmp_path / "two.json").read_bytes()
    assert json.loads(one)["schema"] == SCHEMA


def test_neighbours_are_named_by_id(tmp_path):
    source = copy.deepcopy(SMALL)
    for taxel in source["taxels"]:
        taxel["id"] += 100
        taxel["neighbours"] = [j + 100 for j in taxel["neighbours"]]
    layout = layout_from_dict(source)
    assert layout.ids.tolist() == [t["id"] for t in source["taxels"]]
    assert [list(n) for n in layout.neighbours] == [t["neighbours"] for t in SMALL["taxels"]]
    assert_same(layout, layout_from_dict(layout_to_dict(layout)))


def test_mixed_shapes_and_sizes_are_read():
    source = copy.deepcopy(SMALL)
    extra = len(source["vertices"])
    source["vertices"] += [[0.2, 0.0, 0.01], [0.21, 0.0, 0.01], [0.21, 0.02, 0.01], [0.2, 0.02, 0.01]]
    square = {"id": 77, "position": [0.205, 0.01, 0.01], "corners": [extra, extra + 1, extra + 2, extra + 3]}
    source["taxels"].append(square | {"rotation_taxel_to_sole": np.eye(3).tolist(), "area": 2e-4, "neighbours": []})
    source["cell_shape"] = "mixed"
    layout = layout_from_dict(source)
    assert (len(layout.corners[-1]), layout.areas[-1], layout.ids[-1]) == (4, 2e-4, 77)


def places(value, path=()):
    """Every place in nested JSON values, as a path of keys."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        # One taxel, one vertex and one outline point stand for the others.
        if path not in {("taxels",), ("vertices",), ("outline",)} or key == 1:
            yield (*path, key)
            yield from places(item, (*path, key))


def at(source, path):
    for key in path:
        source = source[key]
    return source


PLACES = [p for p in places(SMALL) if p[0] != "units"]  # "units" is a note to the reader of the file
WRONG = [None, True, "x", "", {}, [], [[]], [None], -1, 0.5, 1e30, 10**400, math.nan, math.inf, "\n", {"a": [1]}]


def refused(source):
    """The message of the error, or None where the layout is taken; any other exception fails the test."""
    try:
        layout_from_dict(json.loads(json.dumps(source)), where="sole.json")
    except LayoutError as error:
        return str(error)
    return None


def named(path):
    """The field's name as the message must hold it: the innermost key that is a word."""
    return next(str(key) for key in reversed(path) if isinstance(key, str))


@pytest.mark.parametrize("path", [p for p in PLACES if isinstance(p[-1], str)], ids=str)
def test_a_missing_field_is_named(path):
    source = copy.deepcopy(SMALL)
    del at(source, path[:-1])[path[-1]]
    message = refused(source)
    if path[0] in ("ranges", "thresholds") and len(path) == 2:
        assert message is None  # a sole states those of its own modalities
    else:
        assert (
            message
            == f"sole.json: {'taxel 1: ' if path[0] == 'taxels' and len(path) > 1 else ''}field '{path[-1]}' is missing"
        )


def fault(path, value):
    """What is wrong with how a layout with a wrong value is taken; None where it is refused as it must, or harmless."""
    source = copy.deepcopy(SMALL)
    at(source, path[:-1])[path[-1]] = value
    message = refused(source)
    if message is None:
        original = at(SMALL, path)
        return None if harmless(path, value, original) else f"{path} = {value!r} was taken for {original!r}"
    # The checks that the layout makes itself use the plural or shorter name of its own field.
    word = {"rotation_taxel_to_sole": "rotation", "taxels": "taxel"}.get(named(path), named(path))
    names_it = word in message or (named(path) == "id" and "neighbours" in message)
    told = message.startswith("sole.json: ") and "\n" not in message and names_it
    return None if told else f"{path} = {value!r}: {message}"


@pytest.mark.parametrize("path", PLACES, ids=str)
def test_a_wrong_value_is_refused_in_one_line_or_harmless(path):
    """Each field takes each wrong value: what comes is a LayoutError that names file and field, or a sound layout."""
    assert [told for value in WRONG if (told := fault(path, value))] == []


def harmless(path, value, original):
    """A value of the field's own kind that a layout may hold: another number, another name, a shorter list."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    field = named(path)
    if field == "name":
        return isinstance(value, str)
    if field in ("ranges", "thresholds", "modalities", "neighbours") and value in ({}, []):
        return True
    if field == "taxels" and value == []:
        return True
    if isinstance(original, (int, float)) and number:
        return (field != "id" and abs(value) <= 50.0) or field in ("force", "proximity", "temperature", "acceleration")
    return False


anything = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)


@given(st.data())
def test_random_damage_never_gives_another_exception(data):
    source = copy.deepcopy(SMALL)
    for _ in range(data.draw(st.integers(1, 4))):
        path = data.draw(st.sampled_from(PLACES))
        with contextlib.suppress(KeyError, IndexError, TypeError):  # an earlier damage may have taken the place away
            at(source, path[:-1])[path[-1]] = data.draw(anything)
    message = refused(source)
    assert message is None or "\n" not in message


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (b"", "not a JSON layout file"),
        (b"{", "not a JSON layout file"),
        (b"\xff\xfe\x00", "not a JSON layout file"),
        (b"[1, 2]", "not a JSON object"),
        (b"null", "not a JSON object"),
        (b"[" * 100_000, "not a JSON layout file"),
        (b'{"a": 1}', "field 'schema' is missing"),
        (b'{"schema": "plantar.layout/9"}', "this version reads 'plantar.layout/1'"),
    ],
)
def test_a_foreign_file_is_refused_in_one_line(tmp_path, content, text):
    path = tmp_path / "layout.json"
    path.write_bytes(content)
    with pytest.raises(LayoutError) as caught:
        read_layout(path)
    assert str(caught.value).startswith(str(path))
    assert text in str(caught.value)
    assert "\n" not in str(caught.value)


@given(st.integers(0, 10**6))
def test_a_truncated_file_is_refused(cut):
    text = json.dumps(SMALL)
    with pytest.raises(LayoutError):
        layout_from_dict_of_text(text[: cut % len(text)])


def layout_from_dict_of_text(text):
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "layout.json"
        path.write_text(text)
        return read_layout(path)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(LayoutError, match=r"nothing\.json: cannot be read \(No such file"):
        read_layout(tmp_path / "nothing.json")
    with pytest.raises(LayoutError, match="cannot be read"):
        read_layout(tmp_path)


def test_writing_where_nothing_can_be_written(sole, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        write_layout(sole, tmp_path / "file" / "layout.json")
    assert [p.name for p in tmp_path.iterdir()] == ["file"]
