"""TOML and JSON of strangers: nothing that is deep, long or no text takes time or ends in a traceback."""

import subprocess
import sys
import time

import pytest

from plantar.common.files.structured_text import (
    JSON_MOST,
    TOML_MOST,
    described_files,
    packaged_files,
    parse_toml,
    read_json,
    read_toml,
)
from plantar.errors import InputError

LARGE = {
    "deep array": "a = " + TOML_MOST * "[",
    "deep inline table": TOML_MOST // 4 * "a={" + "}",
    "dotted key": "a." * (TOML_MOST // 2) + "a = 1",
    "quoted dotted key": "'a'.\"b\"." * (TOML_MOST // 8) + "a = 1",
    "dotted table": "[" + "a." * (TOML_MOST // 2) + "a]",
    "spaced dotted key": "a . " * (TOML_MOST // 4) + "a = 1",
    "long integer": "a = " + (TOML_MOST - 4) * "9",
    "long hexadecimal integer": "a = 0x" + (TOML_MOST - 6) * "f",
    "open text": 'a = "' + (TOML_MOST - 5) * "x",
    "open multi-line text": 'a = """' + (TOML_MOST // 2) * "\\\n",
    "nothing but quotes": TOML_MOST * '"',
    "nothing but blanks": (TOML_MOST - 1) * " " + "=",
}


@pytest.mark.parametrize("text", LARGE.values(), ids=LARGE.keys())
def test_no_toml_takes_long_or_raises_anything_but_one_line(text):
    start = time.process_time()
    with pytest.raises(ValueError, match=r"^[^\n]*$"):
        parse_toml(text)
    assert time.process_time() - start < 5.0


def test_what_is_written_by_people_is_read():
    table = parse_toml('a.b.c = 1\n[x."y z".\'w\']\nversion = "1.2.3.4.5.6"\nlist = [[1, [2]], {k = 0x7f}]\n')
    assert table["a"] == {"b": {"c": 1}}
    assert table["x"]["y z"]["w"] == {"version": "1.2.3.4.5.6", "list": [[1, [2]], {"k": 127}]}


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"a = ", "not valid TOML"),
        (b"\xff\xfea", "no UTF-8 at byte 0"),
        (b"ok = 1\nname = '\xe4'", "no UTF-8 at byte 15"),
        (b"a = " + 100_000 * b"[", "nested too deep"),
        (b"#" * (TOML_MOST + 1), r"holds 250 kB; allowed: up to 250 kB"),
        (b"\0", "not valid TOML"),
    ],
)
def test_a_toml_file_that_is_none_is_one_line(tmp_path, data, reason):
    path = tmp_path / "x.toml"
    path.write_bytes(data)
    with pytest.raises(InputError, match=f"^file x .*{reason}") as caught:
        read_toml(path, InputError, "file x")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "not valid JSON"),
        (b"[" * 1_000_000, "nested too deep"),
        (b'{"a":' * 1_000_000, "nested too deep"),
        (b"9" * 5000, "not valid JSON"),
        (b'"\xff"', "not a text file"),
        (b" " * (JSON_MOST + 1), "allowed: up to 16 MB"),
    ],
)
def test_a_json_file_that_is_none_is_one_line(tmp_path, data, reason):
    path = tmp_path / "x.json"
    path.write_bytes(data)
    with pytest.raises(InputError, match=f"^file x .*{reason}"):
        read_json(path, InputError, "file x")


def test_a_byte_order_mark_is_no_error(tmp_path):
    path = tmp_path / "x"
    path.write_bytes(b"\xef\xbb\xbfa = 1")
    assert read_toml(path, InputError, "x") == {"a": 1}
    path.write_bytes(b"\xef\xbb\xbf[1]")
    assert read_json(path, InputError, "x") == [1]


def test_the_files_of_a_package_are_found_without_loading_it():
    code = (
        "import sys\nfrom plantar.common.files.structured_text import packaged_files\n"
        "found = [p.name for p in packaged_files('plantar.sim', 'scenes/*.toml')]\n"
        "assert found == sorted(found) and 'beam.toml' in found\nassert 'plantar.sim.run' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert packaged_files("plantar.sim", "no_such/*") == []


def test_a_file_without_a_title_or_that_is_broken_is_still_named(tmp_path):
    texts = {"a": 'title = "One\\nTwo"', "b": "x = 1", "c": "x = ", "d": 'description = " D "'}
    for name, text in texts.items():
        (tmp_path / f"{name}.toml").write_text(text)
    told = described_files(sorted(tmp_path.glob("*.toml")))
    assert {path.stem: text for path, text in told.items()} == {"a": "One", "b": "", "c": "", "d": "D"}
