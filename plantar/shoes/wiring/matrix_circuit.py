"""Currents of a sheet on rows and columns by nodal analysis, and what each way of reading it makes of them.

A taxel joins its row and its column by its conductance G. Where row r is at the supply and column c is read, currents
also go by other rows and columns: down c's other taxels, where their rows float, the ghosts. Conductances in S.
"""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Circuit = Literal["floating", "grounded", "solved", "virtual_ground"]
"""Unused rows open, read by a divider; unused rows at ground; the same with all voltages read and each column's
conductances solved for, as the firmware does; and each column held at ground by an amplifier."""

SENSE = 1e-3  # S: a column's resistor to ground, 1 kOhm
DRIVER = 1.0 / 40.0  # S: a pin of the Pico at 12 mA
OPEN = 1e-9  # S: what is left of a row that floats
AMPLIFIER = 1e3  # S: a column that an amplifier holds at ground


def column_voltages(conductances: Array, row: int, *, sense: float, driver: float, idle: float) -> tuple[Array, Array]:
    """Voltages of all columns (c,) and rows (r,) over the supply where a row is driven.

    `conductances` (r, c) of the taxels, 0 where there is none; of a column's `sense` resistor, the driven row's
    `driver`, and the `idle` rows' way to ground, in S. Kirchhoff's current law at every row and column.

    Example:
        >>> columns, rows = column_voltages(np.array([[1e-3]]), 0, sense=1e-3, driver=1e9, idle=0.0)
        >>> columns.round(6).tolist(), rows.round(6).tolist()
        ([0.5], [1.0])
    """
    rows, columns = conductances.shape
    ground = np.full(rows, idle)
    ground[row] = driver
    laplacian = np.zeros((rows + columns, rows + columns))
    laplacian[:rows, rows:] = -conductances
    laplacian[rows:, :rows] = -conductances.T
    laplacian[np.diag_indices(rows + columns)] = np.concatenate(
        [ground + conductances.sum(axis=1), sense + conductances.sum(axis=0)]
    )
    fed = np.zeros(rows + columns)
    fed[row] = driver
    found = np.linalg.solve(laplacian, fed)
    return found[rows:], found[:rows]


def read_conductances(conductances: Array, circuit: Circuit, *, driver: float = DRIVER) -> Array:
    """Gives what a `circuit` reads of the `conductances` (rows, columns) of taxels, in S, by nodal analysis.

    `driver`: conductance of the outputs that drive the rows, in S. Rows that are not read are open ("floating") or
    driven to ground (the others).

    Example:
        >>> alone = np.array([[2e-4, 0.0], [0.0, 0.0]])
        >>> read_conductances(alone, "solved").round(6).tolist()
        [[0.0002, 0.0], [0.0, 0.0]]
    """
    idle = OPEN if circuit == "floating" else driver
    sense = AMPLIFIER if circuit == "virtual_ground" else SENSE
    count = len(conductances)
    found = [column_voltages(conductances, r, sense=sense, driver=driver, idle=idle) for r in range(count)]
    volts = np.array([columns for columns, _ in found])
    levels = np.array([rows for _, rows in found])
    if circuit == "virtual_ground":
        return np.asarray(sense * volts / np.diag(levels)[:, None])
    if circuit == "solved":
        # Of each column, the sum of G x (row's voltage - column's) is the sense's current, whichever row is driven.
        systems = levels[None] - volts.T[:, :, None]
        return np.asarray(np.linalg.solve(systems, sense * volts.T[..., None])[..., 0].T)
    return np.asarray(sense * volts / (1.0 - volts))  # a divider of one taxel and the resistor


def ghost_error(conductances: Array, circuit: Circuit) -> tuple[float, float]:
    """Largest error of a pressed taxel over its own conductance, and largest reading of one that is not pressed over
    the largest conductance; pressed are those above a hundredth of it.
    """
    read = read_conductances(conductances, circuit)
    most = float(conductances.max())
    pressed = conductances > 0.01 * most
    wrong = np.abs(read - conductances)[pressed] / conductances[pressed]
    ghosts = (read - conductances)[~pressed & (conductances > 0.0)] / most
    return float(wrong.max()), float(max(0.0, ghosts.max(initial=0.0)))
