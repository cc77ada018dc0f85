"""The tables of safety_campaign.md: counts by kind, robot and phase, and what fell or stayed without a name."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from campaign_faults import PAIRS, WHY_LATE

from plantar.bench.intervals import wilson_interval
from plantar.bench.tables import markdown_table

Row = dict[str, Any]

SOON = 0.3  # s within which a fault has to be named
LIMP = 1.2  # s after a fall within which a robot has to be limp
WATCHED = 5.0  # s after the fault's begin
LARGEST = 2.5  # of an undisturbed step's largest move in a tick
WORST = 12  # moves that are listed


def parts(key: str) -> tuple[str, str, str, str]:
    """Fault, robot, phase and what the controller knows ("": nothing) of a row."""
    fault, robot, phase, *knows = key.split("|")
    return fault, robot, phase, knows[0] if knows else ""


def share(count: int, of: int) -> str:
    """Count with Wilson's interval at 95 % in percent."""
    if not of:
        return "-"
    low, high = wilson_interval(count, of)
    return f"{count}/{of} ({100 * low:.0f}-{100 * high:.0f})"


def largest_move(row: Row, usual: tuple[float, float]) -> float:
    """Largest move of CoM or a foot in a tick, over an undisturbed walk's."""
    return max(move / most for move, most in zip(row["moves"], usual, strict=True))


def survivors(rows: Mapping[str, Row]) -> dict[str, bool]:
    """Whether a controller that knew the fault stayed on its feet, of each run that fell and was repeated so."""
    found: dict[str, bool] = {}
    for key, row in rows.items():
        fault, robot, phase, knows = parts(key)
        if knows:
            plain = f"{fault}|{robot}|{phase}"
            found[plain] = found.get(plain, False) or row["fell"] is None
    return found


def counted(
    rows: Mapping[str, Row], known: Mapping[str, bool], usual: Mapping[str, tuple[float, float]]
) -> tuple[str, ...]:
    """Cells of some runs that knew nothing."""
    falls = {key: row for key, row in rows.items() if row["fell"] is not None}
    survived = len(rows) - len(falls)
    survivable = survived + sum(known.get(key, False) for key in falls)
    stiff = sum(row["stiffness"] != 0.0 and row["fell"] < WATCHED - LIMP for row in falls.values())
    down = sum(row["named"] is None or row["named"] > row["fell"] + SOON for row in falls.values())
    named = [row["named"] for row in rows.values() if row["named"] is not None]
    far = sum(largest_move(row, usual[parts(key)[1]]) > LARGEST for key, row in rows.items())
    return (
        share(len(falls), len(rows)),
        str(sum(row["last"] == "limp" for row in falls.values())),
        share(survived, survivable),
        str(stiff),
        str(down),
        share(sum(time <= SOON for time in named), len(rows)),
        str(len(rows) - len(named)),
        str(sum(row["raised"] > 0 for row in rows.values())),
        str(far),
    )


HEADS = (
    "fell",
    "of them let down",
    "on its feet, of what is survivable",
    "fell and stiff",
    "down and unnamed",
    "named in 0.3 s",
    "never named",
    "raised inside",
    "moves over 2.5",
)


def grouped(
    title: str,
    groups: Iterable[tuple[str, dict[str, Row]]],
    known: Mapping[str, bool],
    usual: Mapping[str, tuple[float, float]],
) -> str:
    lines = [(name, *counted(rows, known, usual)) for name, rows in groups if rows]
    return markdown_table((title, *HEADS), lines)


def faults(rows: Mapping[str, Row], known: Mapping[str, bool]) -> str:
    """A line for each fault with falls."""
    lines = []
    for name in sorted({parts(key)[0] for key, row in rows.items() if row["fell"] is not None}):
        mine = {key: row for key, row in rows.items() if parts(key)[0] == name}
        falls = [key for key, row in mine.items() if row["fell"] is not None]
        places = ", ".join(f"{parts(key)[1]} {parts(key)[2]}" for key in sorted(falls))
        lines.append(
            (
                name,
                f"{len(falls)}/{len(mine)}",
                f"{sum(known.get(key, False) for key in falls)}/{sum(key in known for key in falls)}",
                places,
            )
        )
    return markdown_table(("fault", "fell", "survivable, of those repeated", "where: robot and phase"), lines)


def unnamed(rows: Mapping[str, Row]) -> str:
    """A line for each fault that was not named in time at every run."""
    lines = []
    for name in sorted({parts(key)[0] for key in rows if parts(key)[0] not in PAIRS}):
        mine = [row for key, row in rows.items() if parts(key)[0] == name]
        late = sorted(row["named"] for row in mine if row["named"] is not None and row["named"] > SOON)
        never = sum(row["named"] is None for row in mine)
        if late or never:
            slowest = f"{late[-1]:.2f} s" if late else "-"
            fell = sum(row["fell"] is not None for row in mine)
            lines.append((name, len(mine), len(late), slowest, never, fell, WHY_LATE.get(name, "-")))
    return markdown_table(("fault", "runs", "named after 0.3 s", "slowest", "never named", "fell", "why"), lines)


def moves(rows: Mapping[str, Row], usual: Mapping[str, tuple[float, float]]) -> str:
    """The runs with the largest moves."""
    far = sorted(((largest_move(row, usual[parts(key)[1]]), key) for key, row in rows.items()), reverse=True)
    return markdown_table(
        ("fault", "robot", "phase", "largest move", "state"),
        [(*parts(key)[:3], f"{move:.2f}", rows[key]["last"] or "walks") for move, key in far[:WORST]],
    )


def page(given: Mapping[str, Row], usual: Mapping[str, tuple[float, float]], robots: Sequence[str]) -> list[str]:
    """Lines of the page's table."""
    known = survivors(given)
    rows = {key: row for key, row in given.items() if not parts(key)[3]}
    by_robot = [(robot, {k: r for k, r in rows.items() if parts(k)[1] == robot}) for robot in robots]
    by_phase = [
        ("stands" if phase == 8 else str(phase), {k: r for k, r in rows.items() if parts(k)[2] == str(phase)})
        for phase in range(9)
    ]
    by_kind = [
        ("single faults", {k: r for k, r in rows.items() if parts(k)[0] not in PAIRS}),
        ("pairs", {k: r for k, r in rows.items() if parts(k)[0] in PAIRS}),
        ("all", rows),
    ]
    return [
        *(grouped("runs", by_kind, known, usual), ""),
        *(grouped("robot", by_robot, known, usual), ""),
        *(grouped("phase", by_phase, known, usual), ""),
        *("Faults with falls:", "", faults(rows, known), ""),
        *("Single faults that were not named in 0.3 s at every run:", "", unnamed(rows), ""),
        *("The largest moves of a target in a tick, over an undisturbed walk's:", "", moves(rows, usual)),
    ]
