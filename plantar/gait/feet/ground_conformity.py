"""Ground conformity: the sole turns with its center of pressure's error (Caron et al. 2019).

    w = k ((p - c) x e_z),     [w_x, w_y] = k [p_y - c_y, -(p_x - c_x)]

An incoming foot turns until contacts enclose its middle c, the stance foot if the desired ZMP c is beyond them. On
partial ground c is that part's middle, and a stance foot does not turn over its edge.
"""

import math
from collections import deque
from collections.abc import Mapping
from itertools import islice
from types import MappingProxyType
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed, share
from plantar.common.sides import SIDES, Side
from plantar.gait.contact.contact_memory import ContactMemory
from plantar.gait.plan.phases import Phase
from plantar.kernels.base.vectors import vector2
from plantar.kernels.gait.touching_cells import along_sole
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.percepts.percept import Percept

_ORIGIN = np.zeros(2)


class ConformityGains(Part, table="conformity", needs={"control.pfc": (True,), "control.conform": (True,)}):
    """Gains of ground conformity.

    Attributes:
        gap: Rise in m of a lifted cell.
    """

    # k on firm ground, in rad/s per m for each newton carried; chosen: bounded by the delay of 20 ms, with which a
    # quicker turn swings
    firm: float = fixed(0.313, "rad/beat/sole/weight")
    # k of a foot rolling over an edge in rad/s per m; chosen: bounded likewise
    rolling: float = fixed(0.309, "rad/beat/sole")
    # Distance in m from its target within which an incoming foot is not turned; chosen: 10 mm of 250, the error of a
    # CoP under little load
    nearly: float = fixed(0.04, "sole")
    largest_rate: float = fixed(0.148, "rad/beat")  # Largest rate of a turn in rad/s; chosen: 0.6 rad/s on h1
    # Vertical force in N from which a centre of pressure means something; derived: the least normal force of the law,
    # 15 N
    least_load: float = fixed(0.0178, "weight")
    # Force in N of a landed foot before it takes weight over; chosen: 80 N on h1
    press: float = fixed(0.0948, "weight")
    # Distance in m that a centre of pressure goes at least for each rad of a turn on firm ground
    follows: float = fixed(4.0, "sole/rad")  # chosen: a firm sole's CoP goes 1 m a radian; on an edge it stays
    watch: ClassVar[float] = 0.08  # Time in s over which rolling is judged; chosen: four delays of sensors and drives
    # Turn in rad, in the first half of them, from which it is; chosen: above the noise of encoders
    least_turn: ClassVar[float] = 0.0016
    # Mean force in N from which a cell touches, times cells; chosen: 8 N a cell of 42
    carries: float = fixed(0.398, "weight")
    gap: float = share(1 / 300, "leg", 0, 0.05)  # derived: 2 mm, the noise of a distance


class SoleTurn(NamedTuple):
    """A standing sole's turn: (2,) about x, y in rad, and the fixed-height point (2,) in m."""

    turn: NDArray[np.float64]
    pivot: NDArray[np.float64]


class FootTurn:
    """Turning of one foot. `period` of control in s."""

    def __init__(self, gains: ConformityGains, period: float) -> None:
        self.gains = gains
        self.period = period
        # place and turn
        self._past: deque[tuple[float, float, float]] = deque(maxlen=max(1, round(gains.watch / period)))

    def lift(self) -> None:
        """The foot is in the air."""
        self._past.clear()

    def hold(self, center_of_pressure: NDArray[np.float64]) -> None:
        """A tick without turn; `center_of_pressure` (2,), sole frame, in m."""
        x, y = center_of_pressure.tolist()
        self._past.append((x, y, 0.0))

    def incoming(
        self, load: float, center_of_pressure: NDArray[np.float64], target: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Returns the turn (2,) in rad about x, y of a foot taking weight over, a tick.

        `load`: vertical on it in N; `center_of_pressure` (2,), sole frame, in m; `target`: its wanted place (2,), sole
        frame, in m.
        """
        return self._turn(load, center_of_pressure, target, self.gains.nearly)

    def stance(
        self, load: float, center_of_pressure: NDArray[np.float64], target: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Returns the turn (2,) in rad about x, y of the carrying foot, a tick.

        `load`: vertical on it in N; `center_of_pressure` (2,), sole frame, in m; `target`: desired ZMP (2,), sole
        frame, in m.
        """
        return self._turn(load, center_of_pressure, target, 0.0)

    def _turn(
        self, load: float, center_of_pressure: NDArray[np.float64], target: NDArray[np.float64], nearly: float
    ) -> NDArray[np.float64]:
        """A tick's turn of a foot that stays as it is within a distance of its target."""
        g = self.gains
        x, y = center_of_pressure.tolist()
        wanted_x, wanted_y = target.tolist()
        dx = x - wanted_x
        dy = y - wanted_y
        away = math.hypot(dx, dy)
        if away <= nearly:
            self._past.append((x, y, 0.0))
            return vector2(0.0, 0.0)
        # In rad/s per m, in proportion to load: a servo's stiffness K moves it by K / force a rad.
        rate = g.rolling if self._rolls(x, y, dx, dy, away) else min(g.rolling, g.firm * load)
        # Begins at zero where "nearly" ends, so that the turn does not start and stop at that distance.
        rate *= 1.0 - nearly / away if nearly else 1.0
        turn = self.period * min(g.largest_rate, rate * away)
        self._past.append((x, y, turn))
        return vector2(turn / away * dy, -turn / away * dx) if away else vector2(0.0, 0.0)

    def _rolls(self, x: float, y: float, dx: float, dy: float, away: float) -> bool:
        """Whether the last turns left the center of pressure at x, y, off its target by (dx, dy), unmoved."""
        g = self.gains
        past = self._past
        if len(past) != past.maxlen or away <= g.nearly:
            return False
        # On firm ground a turn moves the load, though the later half of the turns are not seen yet by late sensors; one
        # that does not rolls over an edge or a bump.
        turned = sum(turn for _, _, turn in islice(past, len(past) // 2))
        first_x, first_y, _ = past[0]
        moved = ((first_x - x) * dx + (first_y - y) * dy) / away
        return turned > g.least_turn and moved < g.follows * turned


class GroundConformity:
    """Both feet of a walk.

    `middles`: best place (2,) to load each whole sole, own frame, in m; `period` of control in s; `turns_stance`:
    whether stance feet turn too; not where the balance law turns them.
    """

    def __init__(
        self,
        gains: ConformityGains,
        layouts: Mapping[Side, SoleLayout],
        middles: Mapping[Side, NDArray[np.float64]],
        period: float,
        turns_stance: bool = True,
    ) -> None:
        self.gains = gains
        self.turns_stance = turns_stance
        self._middles = middles
        self._turns = {side: FootTurn(gains, period) for side in SIDES}
        self._contacts = {
            side: ContactMemory(layouts[side], gains.carries / len(layouts[side].positions), gap=gains.gap)
            for side in SIDES
        }

    def update(
        self,
        phase: Phase,
        incoming: Side | None,
        zmp_desired: NDArray[np.float64],
        state: BaseState,
        percepts: Mapping[Side, Percept],
        landed: bool,
        parts: Mapping[Side, NDArray[np.float64]] = MappingProxyType({}),
    ) -> dict[Side, SoleTurn]:
        """Standing soles' turns at a tick.

        `incoming`: standing foot taking weight over; None at both ends of the walk; `zmp_desired` (2,), world frame, in
        m; `landed`: whether the swing foot has touched; `parts`: carrying part's middle (2,), sole frame, in m, of
        partially standing soles. Returns for each turning sole.
        """
        turned: dict[Side, SoleTurn] = {}
        for side in SIDES:
            turns = self._turns[side]
            contacts = self._contacts[side]
            if phase.swing == side and not landed:
                turns.lift()
                contacts.lift()
                continue
            load = state.loads[side]
            cop = percepts[side].position_cop_in_sole
            if cop is None or load < self.gains.least_load:
                continue
            rotation = state.rotations_sole[side]
            contacts.update(percepts[side].reading, rotation, cop)
            if phase.stance == side:
                target = along_sole(rotation, state.positions_sole[side], zmp_desired)
                # Once the other foot is down, the desired ZMP may lie beyond this sole: no turn brings the load there.
                if self.turns_stance and side not in parts and not landed and not contacts.encloses(target):
                    turned[side] = SoleTurn(turns.stance(load, cop, target), _ORIGIN)
                    continue
            elif side == incoming:
                middle = parts.get(side, self._middles[side])
                if not contacts.encloses(middle):
                    turned[side] = SoleTurn(turns.incoming(load, cop, middle), cop)
                    continue
            turns.hold(cop)
        return turned
