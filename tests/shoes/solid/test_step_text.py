"""The shortened text of a STEP file has each entity that it had, once."""

import re

from plantar.shoes.solid.step_text import with_shared_entities

HEAD, TAIL = "ISO;\nDATA;\n", "\nENDSEC;\nEND;\n"


def entities(text: str) -> dict[str, str]:
    return dict(re.findall(r"#(\d+) ?= ?([^;]*);", text))


def test_equal_lines_and_planes_are_stored_once_and_each_reference_holds():
    point = "CARTESIAN_POINT('',(1.000000000001,-2.5E-10,{}))"
    rows = [point.format("3."), point.format("3.0000000001"), point.format("4."), "DIRECTION('#1',(0.,0.,1.))"]
    rows += [f"AXIS2_PLACEMENT_3D('',#{n},#4,$)" for n in (1, 2, 3)] + [f"PLANE('',#{n})" for n in (5, 6, 7)]
    rows.append("FACES((#8,#9,#10))")
    text = HEAD + "\n".join(f"#{n} = {row};" for n, row in enumerate(rows, start=1)) + TAIL
    short = with_shared_entities(text)
    found = entities(short)
    assert short.startswith(HEAD)
    assert short.endswith(TAIL)
    assert sorted(body.partition("(")[0] for body in found.values()).count("PLANE") == 2
    assert "CARTESIAN_POINT('',(1.,0.,3.))" in found.values()
    assert "DIRECTION('#1',(0.,0.,1.))" in found.values()
    assert all(n in found for body in found.values() for n in re.findall(r"#(\d+)", re.sub("'[^']*'", "", body)))
    faces = re.findall(r"#(\d+)", next(body for body in found.values() if body.startswith("FACES")))
    assert faces[0] == faces[1] != faces[2]
    assert {found[n].partition("(")[0] for n in faces} == {"PLANE"}


def test_what_is_named_often_has_a_short_number():
    rows = [*(f"VECTOR('',#12,{n}.)" for n in range(11)), "DIRECTION('',(0.,0.,1.))"]
    text = HEAD + "\n".join(f"#{n} = {row};" for n, row in enumerate(rows, start=1)) + TAIL
    assert entities(with_shared_entities(text))["1"].startswith("DIRECTION")
