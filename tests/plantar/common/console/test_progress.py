"""Progress of a command and of its parts."""

from plantar.common.console.progress import part_of, progress_bar


def test_parts_of_a_part_fill_the_whole():
    told: list[tuple[float, str]] = []
    second = part_of(lambda fraction, text: told.append((fraction, text)), 0.5, 0.5, "b: ")
    part_of(second, 0.0, 0.5)(1.0, "half")
    part_of(second, 0.5, 0.5, "c: ")(1.0, "whole")
    assert told == [(0.75, "b: half"), (1.0, "b: c: whole")]


def test_the_bar_is_silent_where_nobody_looks(capsys):
    with progress_bar() as tell:
        tell(0.3, "some of it")
        tell(1.0, "all of it")
    assert tuple(capsys.readouterr()) == ("", "")
