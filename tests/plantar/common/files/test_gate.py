"""What the gate declares is what it does, and what SECURITY.md promises has a test."""

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from plantar.common.files import gate
from plantar.common.files.gate import HELPERS, PROMISES, Helper, read_apart
from plantar.common.files.model_files import check_model
from plantar.common.files.model_limits import check_model_size
from plantar.common.files.xml_file import parse_xml
from plantar.errors import PlantarError, RobotError

pytestmark = pytest.mark.apart

ROOT = Path(__file__).parents[4]


def test_security_md_is_made_of_what_the_gate_declares():
    command = [sys.executable, "tools/security_page.py", "--check"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("promise", PROMISES)
def test_a_promise_has_a_test(promise):
    tree = ast.parse((ROOT / PROMISES[promise]).read_text(encoding="utf-8"))
    assert any(isinstance(node, ast.FunctionDef) and node.name.startswith("test_") for node in tree.body)


@pytest.mark.parametrize("kind", HELPERS)
def test_a_helper_is_there(kind):
    module, _, name = HELPERS[kind].function.partition(":")
    assert callable(getattr(import_module(module), name))


def test_native_readers_are_called_by_helpers_alone():
    native = {"ezc3d", "rosbags", "ezdxf", "trimesh", "collada", "xlrd"}
    own = {HELPERS[kind].function.partition(":")[0].replace(".", "/") + ".py" for kind in HELPERS}
    for path in sorted((ROOT / "plantar").rglob("*.py")):
        where = path.relative_to(ROOT).as_posix()
        if where in own or ("/formats/" not in where and "/foot/" not in where):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [n.name for n in node.names] if isinstance(node, ast.Import) else []
            names += [str(node.module)] if isinstance(node, ast.ImportFrom) else []
            assert not {name.partition(".")[0] for name in names} & native, where
        assert ".imdecode(" not in path.read_text(encoding="utf-8"), where


@pytest.mark.parametrize(
    ("memory", "seconds", "does", "why"),
    [(300e6, 10.0, "bytearray(2_000_000_000)", "MB of memory"), (300e6, 1.0, "sum(iter(int, 1))", "longer")],
)
def test_a_helper_ends_at_its_limit(memory, seconds, does, why, tmp_path, monkeypatch):
    (tmp_path / "greedy.py").write_text(f"def read(path):\n    while True:\n        {does}\n        return {{}}\n")
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{ROOT}")
    helper = Helper("greedy:read", "a thing", (memory, 0.0), (seconds, 0.0), "none")
    monkeypatch.setattr(gate, "HELPERS", {"thing": helper})
    with pytest.raises(PlantarError, match=why):
        read_apart("thing", __file__, PlantarError)


@pytest.mark.parametrize(
    "inside",
    [
        '<worldbody><replicate count="3000"><geom size="1"/></replicate></worldbody>',
        '<worldbody><replicate count="50"><replicate count="50"><body/></replicate></replicate></worldbody>',
        '<asset><hfield name="h" nrow="60000" ncol="60000"/></asset>',
        '<asset><texture type="2d" width="100000" height="10"/></asset>',
        '<asset><mesh builtin="sphere" params="99999"/></asset>',
        '<size memory="1T"/>',
        '<size memory="3G"/>',
        '<size nuserdata="1e9"/>',
        '<custom><numeric name="a" size="100000000"/></custom>',
        '<worldbody><flexcomp count="1000 1000 1000"/></worldbody>',
    ],
)
def test_a_model_that_asks_for_more_than_a_robot_is_refused(inside):
    root = parse_xml(f"<mujoco>{inside}</mujoco>".encode(), PlantarError, "a.xml")
    with pytest.raises(PlantarError, match=r"a\.xml: .*allowed: up to"):
        check_model_size(root, PlantarError, "a.xml")


def test_a_robots_model_passes(tmp_path):
    text = '<size memory="100M" nuserdata="600000"/><worldbody><replicate count="20"><body><geom/></body></replicate>'
    root = parse_xml(f"<mujoco>{text}</worldbody></mujoco>".encode(), PlantarError, "a.xml")
    check_model_size(root, PlantarError, "a.xml")


@pytest.mark.parametrize("text", ['<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "<a>" * 300, "<a>" + "<b/>" * 200_001])
def test_xml_that_grows_is_refused(text):
    with pytest.raises(PlantarError, match=r"entities|deep|elements"):
        parse_xml(text.encode(), PlantarError, "a.xml")


def test_models_that_attach_each_other_are_refused_after_a_trial(tmp_path):
    pytest.importorskip("mujoco")
    for i in range(5):
        inner = "".join(f'<attach model="m" prefix="p{j}"/>' for j in range(9)) if i < 4 else '<geom size="1"/>'
        asset = f'<asset><model name="m" file="b{i + 1}.xml"/></asset>' if i < 4 else ""
        body = f'<mujoco>{asset}<worldbody><body name="r">{inner}</body></worldbody></mujoco>'
        (tmp_path / f"b{i}.xml").write_text(body)
    with pytest.raises(PlantarError, match=r"has \d+ bodies; allowed: up to 2000|longer than"):
        check_model(tmp_path / "b0.xml", PlantarError)


def test_a_model_is_tried_once_whoever_asks(tmp_path, monkeypatch):
    pytest.importorskip("mujoco")
    file, tried = tmp_path / "a.xml", list[str]()
    file.write_text('<mujoco><worldbody><body name="b"><geom size="1"/></body></worldbody></mujoco>')
    monkeypatch.setattr(
        "plantar.common.files.model_files.read_apart", lambda kind, *_: tried.append(kind) or {"bodies": 2}
    )
    for error in (PlantarError, RobotError):
        check_model(file, error)
    assert tried == ["model"]


def test_mujoco_s_warnings_of_a_model_go_to_the_caller_alone(tmp_path, monkeypatch, capfd):
    mujoco = pytest.importorskip("mujoco")
    monkeypatch.chdir(tmp_path)
    text = '<mujoco><worldbody><body name="b"><geom size="1" pos="nan 0 0"/></body></worldbody></mujoco>'
    (tmp_path / "a.xml").write_text(text)
    before, taken = mujoco.get_mju_user_warning(), list[str]()
    try:
        for handler in (None, taken.append):
            mujoco.set_mju_user_warning(handler)
            check_model(tmp_path / "a.xml", PlantarError)
            mujoco.MjSpec.from_file("a.xml")
    finally:
        mujoco.set_mju_user_warning(before)
    assert ["NaN" in warning for warning in taken] == [True]
    assert [path.name for path in tmp_path.iterdir()] == ["a.xml"]
    assert capfd.readouterr().err == ""
