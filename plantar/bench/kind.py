"""What a kind of `plantar bench` is made of: its cases, and what their rows show."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

Row = Mapping[str, Any]
"""Values by column; texts where they come from a file."""


@dataclass(frozen=True)
class BenchOptions:
    """Options of all kinds; each takes some of them.

    Attributes:
        scenarios: Number of scenarios of the whole loop.
        first: Number of the first one.
        scene: Scenes or kinds of trial; all where empty.
        robot: Robots to run them with; all where empty.
        quick: Run the most informative cases, once.
        policy: Python file, or None for the built-in controller.
        seeds: Runs of each trial.
    """

    scenarios: int = 10_000
    first: int = 0
    scene: tuple[str, ...] = ()
    robot: tuple[str, ...] = ()
    quick: bool = False
    policy: Path | None = None
    seeds: int = 100


class Case(NamedTuple):
    """One measurement: values of the key columns, and what gives the other values, a row or several."""

    key: tuple[str, ...]
    measure: Callable[[], Sequence[Row]]


class PageTable(NamedTuple):
    """A table of a page, under a heading."""

    heading: str
    head: Sequence[str]
    rows: Sequence[Sequence[Any]]


class Finding(NamedTuple):
    """What the rows of a kind show.

    Attributes:
        result: Plain JSON values by name.
        tables: Of the page and the terminal.
        failures: A line each; any is exit code 1.
        draw: Draws the page's figure into a PNG file, or None.
        summary: Rows of another CSV file, named as the page; empty for none.
    """

    result: dict[str, Any]
    tables: Sequence[PageTable]
    failures: Sequence[str] = ()
    draw: Callable[[Path], None] | None = None
    summary: Sequence[Row] = ()


@dataclass(frozen=True)
class Kind:
    """A kind of `plantar bench`.

    Attributes:
        page: Name of the page's file without ".md".
        title: Of the page.
        lead: What the page explains above its tables.
        table: Name of the CSV file of rows.
        keys: Columns that name a case.
        columns: The other ones.
        cases: Cases by the options, in the order in which they run.
        find: What the rows of these cases show.
        resumes: Whether a later run continues the table, or else measures everything again.
    """

    page: str
    title: str
    lead: str
    table: str
    keys: tuple[str, ...]
    columns: tuple[str, ...]
    cases: Callable[[BenchOptions], Sequence[Case]]
    find: Callable[[Sequence[Row], BenchOptions], Finding]
    resumes: bool = True
