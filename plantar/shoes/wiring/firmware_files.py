"""Firmware of a shoe: C files of the package, and the header that makes them this sole's. Places in mm."""

from pathlib import Path

import numpy as np

from plantar.common.files.structured_text import packaged_files
from plantar.shoes.build import Shoe
from plantar.shoes.units import to_mm
from plantar.shoes.wiring.nets import Wiring

_PERIOD = {"divider": 5_000, "matrix": 10_000, "bridge": 12_500}  # us: 200, 100 and 80 readings a second


def firmware_sources() -> dict[str, Path]:
    """The package's C files by name.

    Example:
        >>> sorted(firmware_sources())
        ['hardware.h', 'hardware_pico.c', 'hardware_simulated.c', 'sole.c']
    """
    return {
        path.name: path for ending in ("c", "h") for path in packaged_files("plantar.shoes", f"firmware/*.{ending}")
    }


def header_text(shoe: Shoe, wiring: Wiring) -> str:
    """Gives `sole.h` of a shoe and its wiring: how it is read, and each taxel's line, id and place in the layout's
    order.
    """
    plan = shoe.plan
    ids = shoe.layout.ids.tolist()
    rows, columns = (0, len(ids)) if plan.lines is None else plan.sheet_lines
    lines = [[0, k] for k in range(len(ids))] if plan.lines is None else plan.lines.tolist()
    places = to_mm(shoe.layout.positions[:, :2]).round().astype(int).tolist()
    # The simulated sole rolls along x, whichever way that is.
    middle = int(np.mean([y for _, y in places]))
    return "\n".join(
        [
            f"/* {shoe.layout.name}, {shoe.side}: {len(ids)} taxels in the order of layout_{shoe.side}.json */",
            f"#define SIDE {0 if shoe.side == 'left' else 1}",
            f"#define CIRCUIT_{wiring.circuit.upper()}",
            f"#define TAXELS {len(ids)}",
            f"#define ROWS {rows}",
            f"#define COLUMNS {columns}",
            f"#define PERIOD_US {_PERIOD[wiring.circuit]}",
            f"static const unsigned char LINE[TAXELS][2] = {{{_pairs(lines)}}}; /* row and column */",
            f"static const unsigned short ID[TAXELS] = {{{', '.join(map(str, ids))}}};",
            f"static const short PLACE[TAXELS][2] = {{{_pairs([[x, y - middle] for x, y in places])}}}; /* mm */",
            "",
        ]
    )


def _pairs(pairs: list[list[int]]) -> str:
    return ", ".join(f"{{{a}, {b}}}" for a, b in pairs)
