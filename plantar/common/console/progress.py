"""Progress of a command, as a bar on stderr."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from plantar.common.console.ending import one_line

Progress = Callable[[float, str], None]
"""Receives the fraction done, 0..1, and what is being done."""


@contextmanager
def progress_bar() -> Iterator[Progress]:
    """Show a progress bar on stderr, if that is a terminal.

    Yields moves the bar: takes fraction done, 0..1, and text.
    """
    from rich.console import Console  # 0.1 s, which `plantar --help` need not wait for
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (BarColumn(), TextColumn("{task.description}", markup=False), TimeElapsedColumn())
    console = Console(stderr=True)
    with Bar(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("", total=1.0)
        yield lambda fraction, text: bar.update(task, completed=fraction, description=one_line(text))


def part_of(whole: Progress, start: float, share: float, name: str = "") -> Progress:
    """Returns progress of a part of some work, from that of the `whole`: from fraction `start` on, a `share` of it,
    texts after `name`.

    Example:
        >>> part_of(lambda fraction, text: print(fraction, text), 0.5, 0.25, "walk: ")(0.5, "step 3")
        0.625 walk: step 3
    """
    return lambda fraction, text: whole(start + share * fraction, f"{name}{text}")
