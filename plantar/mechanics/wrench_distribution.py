"""Share a net wrench between contacts: the quadratic program of Caron et al. 2019, T 4.4.4.

Unknown is the wrench w_i of each contact in its frame. With J_i w_i that wrench about the contacts' middle in world
axes and e = sum J_i w_i - w_d, it minimises

    net |e|^2 + ankle sum |m_i|^2 + sum_(i<j) (pressure (s_j fz_i - s_i fz_j)^2 + horizontal |s_j h_i - s_i h_j|^2)
    + friction sum (fx_i^2 + fy_i^2 + tz_i^2)

with h_i the horizontal force (x, y) of contact i in the world, m_i the moment (x, y) about its preferred center of
pressure, s_i its wanted share of the normal force, forces in body weights and moments in body weights times 0.1 m. Each
w_i stays in its wrench cone, its normal force at or above a minimum.
"""

# By Lagrange's identity the sum over pairs is |s|^2 |fz|^2 - (s . fz)^2.

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from enum import StrEnum

import daqp
import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import positive
from plantar.common.record import Record
from plantar.errors import InputError
from plantar.kernels.mechanics.wrench_program import WrenchProgram
from plantar.mechanics.contact import Contact, Contacts
from plantar.mechanics.wrench_cone import Rectangle, cone_rows
from plantar.mechanics.zmp import zmp_in_plane

_ROWS = 17  # nature: of one contact: 16 facets of the cone and the least normal force
# on wrenches while the violations alone are minimised; derived: eight decades below the violations' own weight of 1,
# eight above a rounding
_RIDGE = 1e-8
# of the body weight (or times the unit of length): a net wrench nearer than this is tracked; chosen: a thousandth of it
# is what `net` leaves
_TRACKED = 0.005


class DistributionState(StrEnum):
    """How a distribution ended.

    `TRACKED`: the contacts give the wanted net wrench; `SATURATED`: no wrenches inside the cones give it; the share
    comes nearest; `INFEASIBLE`: the constraints contradict each other; the share violates them least; `INVALID`: the
    request holds a number that is not finite, or no share above 0; the contacts take the body's weight where they
    prefer it.
    """

    TRACKED = "tracked"
    SATURATED = "saturated"
    INFEASIBLE = "infeasible"
    INVALID = "invalid"
    AIRBORNE = "airborne"


@dataclass(frozen=True)
class DistributionWeights:
    """Weights of the cost; only ratios matter.

    `ankle` of moments about preferred centers of pressure (foot compliance); `pressure` of deviation from wanted
    proportion of normal forces; `horizontal` of horizontal forces' deviation from it, which presses contacts against
    each other: at a hip, 0.8 m up, a newton makes eight of the units of length that an ankle's moment is counted in;
    `friction` of tangential forces and yaw moments; makes share unique.
    """

    net: float = 1e4  # nature: Caron et al. 2019 (T's reference 127)
    ankle: float = 10.0  # chosen: three decades below `net`, so that the net wrench is tracked to a thousandth
    pressure: float = 0.1  # chosen: two decades below `ankle`: feet that balance come before feet that share
    horizontal: float = 640.0  # derived: 8^2 times `ankle`, for the eight units of length that a newton makes
    friction: float = 0.01  # chosen: small beside all others: it only decides where they do not

    def __post_init__(self) -> None:
        for item in fields(self):
            positive(getattr(self, item.name), f"distribution weight '{item.name}'")


class WrenchShare(Record, frozen=True):
    """Wrenches of a distribution.

    `wrenches`: wrench (6,) of each contact by name, in its frame about its origin, by world on robot; `error`: their
    sum minus wanted net wrench (6,) in world frame, about middle of contacts; `violation`: violation in N of worst
    constraint; 0 unless infeasible.
    """

    state: DistributionState
    wrenches: Mapping[str, NDArray[np.float64]]
    error: NDArray[np.float64]
    violation: float

    def center_of_pressure(self, name: str) -> NDArray[np.float64] | None:
        """Center of pressure (2,) of a contact in its frame in m; None without load (below 1 mN)."""
        return zmp_in_plane(self.wrenches[name], minimum_force=1e-3)  # nature: no load, at any scale of robots


@dataclass(frozen=True)
class Program:
    """One call's quadratic program: minimise 1/2 v' H v + f' v subject to A v <= b.

    `hessian`: H (n, n); `gradient`: f (n,); `constraints`: A (m, n); `upper`: b (m,); `unit`: unit (n,) of v in N and N
    m.
    """

    hessian: NDArray[np.float64]
    gradient: NDArray[np.float64]
    constraints: NDArray[np.float64]
    upper: NDArray[np.float64]
    unit: NDArray[np.float64]


class _Workspace:
    """Arrays and solver for one number of contacts, filled in place."""

    def __init__(self, count: int, weight: float, length: float, weights: DistributionWeights) -> None:
        n = 6 * count  # nature: the size of a wrench
        self.unit = np.tile(weight * np.array([1.0, 1.0, 1.0, length, length, length]), count)
        self.jacobian = np.zeros((6, n))
        self.costly = np.zeros((6, n))  # the Jacobian times the cost of the net wrench
        # What does not depend on poses and shares.
        self.own = np.diag(np.tile([1.0, 1.0, 0.0, 0.0, 0.0, 1.0], count)) * weights.friction
        self.fixed = np.zeros((n, n))  # what does not depend on the shares
        self.hessian = np.eye(n)
        self.wanted = np.zeros(6)
        self.gradient = np.zeros(n)
        self.constraints = np.zeros((_ROWS * count, n))
        self.upper = np.zeros(_ROWS * count)
        self.lower = np.full(_ROWS * count, -1e30)  # nature: the solver's infinity
        self.contacts: list[Contact | None] = [None] * count
        self.solver: daqp.Model | None = None
        # since the solver had them: other contacts' limits, another Hessian
        self.limited = False
        self.changed = False
        scales = (weight, length, weights.net, weights.pressure, weights.horizontal)
        filled = (self.fixed, self.hessian, self.wanted, self.gradient)
        self.program = WrenchProgram(scales, self.unit, self.jacobian, *filled)

    def loaded_solver(self) -> daqp.Model:
        """The solver with the present program."""
        if self.solver is None:
            self.solver = daqp.Model()
            # nature: floating point: constraints are of order 1, and six decades of roundings are left
            self.solver.settings = {"primal_tol": 1e-10}
            self.solver.setup(self.hessian, self.gradient, self.constraints, self.upper, self.lower)
        elif self.limited:  # its bounds never change: only the least force differs from 0
            self.solver.update(H=self.hessian, f=self.gradient, A=self.constraints)
        elif self.changed:
            self.solver.update(H=self.hessian, f=self.gradient)
        else:
            self.solver.update(f=self.gradient)
        self.limited = False
        self.changed = False
        return self.solver

    def forget(self) -> None:
        """Drop the state, after a request that is not finite."""
        self.contacts = [None] * len(self.contacts)
        self.solver = None


class WrenchDistribution:
    """Distributes net wrenches over contacts; one instance a controller.

    `weight`: weight of robot in N; unit of forces inside program; `minimum_force`: least normal force in N of each
    contact; `length`: unit of moments over forces inside program in m: about half a sole.

    Example:
        >>> flat, sole = np.eye(3), Rectangle(-0.1, 0.1, -0.06, 0.06)
        >>> places = {"left": [0.0, 0.1, 0.0], "right": [0.0, -0.1, 0.0]}
        >>> feet = {name: Contact(np.array(place), flat, sole) for name, place in places.items()}
        >>> share = WrenchDistribution(600.0).solve(feet, [0.0, 0.0, 600.0, 20.0, 0.0, 0.0], [0.0, 0.0, 0.0])
        >>> share.state.value, {name: round(float(wrench[2])) for name, wrench in share.wrenches.items()}
        ('tracked', {'left': 400, 'right': 200})
    """

    def __init__(
        self,
        weight: float,
        weights: DistributionWeights | None = None,
        minimum_force: float = 15.0,  # derived: the law's `minimum_force` of the reference body, 0.0178 weight
        length: float = 0.1,  # derived: the law's `_LENGTH` of the reference body, 1/6 leg
    ) -> None:
        if not (math.isfinite(minimum_force) and minimum_force >= 0.0):
            raise InputError(f"minimum force is {minimum_force} N; allowed: a finite value, 0 or more")
        self.weight = positive(weight, "weight of the robot", "N")
        self.length = positive(length, "unit of length", "m")
        self.weights = weights or DistributionWeights()
        self.minimum_force = minimum_force
        self._workspaces: dict[int, _Workspace] = {}

    def solve(
        self,
        contacts: Contacts,
        wrench: NDArray[np.float64] | Sequence[float],
        point: NDArray[np.float64] | Sequence[float],
        shares: Mapping[str, float] | None = None,
    ) -> WrenchShare:
        """Share a net wrench; an infeasible request is no error, see `DistributionState`.

        `contacts`: contacts by name, in order; none, one or several; `wrench`: wanted net wrench (6,) in world frame
        about `point`, by world on robot; `point`: point (3,) of world frame in m; `shares`: share of normal force of
        each contact, 0 to 1; equal if None.
        """
        if not contacts:
            return WrenchShare(DistributionState.AIRBORNE, {}, -np.asarray(wrench, dtype=float), 0.0)
        work = self._workspace(len(contacts))
        wished = _in_order(contacts, shares)
        if not self._prepare(work, contacts, wrench, point, wished):
            return self._rest(contacts, wished)
        # Mostly the least cost lies inside the cones, and no inequality is active.
        scaled = work.program.least_cost(work.constraints, work.upper)
        flag = 1
        if scaled is None:
            scaled, _, flag, _ = work.loaded_solver().solve()
        state = DistributionState.TRACKED
        violation = 0.0
        if flag < 1:
            scaled = self._least_violating(work)
            state = DistributionState.INFEASIBLE
            violation = self.weight * float((work.constraints @ scaled - work.upper).max())
        largest, error, wrenches = work.program.finish(scaled, contacts)
        if not math.isfinite(largest):
            work.forget()
            return self._rest(contacts, wished)
        if largest > _TRACKED and flag >= 1:
            state = DistributionState.SATURATED
        return WrenchShare(state, wrenches, error, violation)

    def _workspace(self, count: int) -> _Workspace:
        work = self._workspaces.get(count)
        if work is None:
            work = _Workspace(count, self.weight, self.length, self.weights)
            self._workspaces[count] = work
        return work

    def program(
        self,
        contacts: Contacts,
        wrench: NDArray[np.float64] | Sequence[float],
        point: NDArray[np.float64] | Sequence[float],
        shares: Mapping[str, float] | None = None,
    ) -> Program:
        """Copy of the program that `solve` solves, for other solvers.

        `contacts`: one or more contacts; `wrench`, `point` and `shares` as in `solve`.
        """
        if not contacts:
            raise InputError("a wrench distribution without contacts has no program; allowed: one contact or more")
        work = self._workspace(len(contacts))
        if not self._prepare(work, contacts, wrench, point, _in_order(contacts, shares)):
            raise InputError("the request of a wrench distribution needs finite numbers, and shares above 0")
        return Program(
            work.hessian.copy(),
            work.gradient.copy(),
            work.constraints.copy(),
            work.upper.copy(),
            work.unit.copy(),
        )

    def _prepare(
        self,
        work: _Workspace,
        contacts: Contacts,
        wrench: NDArray[np.float64] | Sequence[float],
        point: NDArray[np.float64] | Sequence[float],
        shares: tuple[float, ...],
    ) -> bool:
        """Fill the workspace; False for an invalid request."""
        program = work.program
        if not program.ask(_plain(wrench), _plain(point), shares):
            return False
        moved = False
        limited = False
        for i, contact in enumerate(contacts.values()):
            last = work.contacts[i]
            if contact is last:
                continue
            if last is None or contact.limits != last.limits:
                if not math.isfinite(sum(contact.rectangle) + contact.friction + sum(contact.preferred or ())):
                    work.forget()
                    return False
                limited = True
                self._constrain(work, i, contact)
            moved = program.place(i, contact.position, contact.rotation) or moved or last is None
            work.contacts[i] = contact
        if moved and not program.turn():
            work.forget()
            return False
        if moved or limited:
            np.multiply(work.jacobian, self.weights.net, out=work.costly)
            work.jacobian.T.dot(work.costly, out=work.fixed)
            work.fixed += work.own
        changed = program.weigh(moved or limited)
        program.aim()
        work.wanted.dot(work.jacobian, out=work.gradient)
        program.finish_gradient()
        work.limited = work.limited or limited
        work.changed = work.changed or changed
        return True

    def _constrain(self, work: _Workspace, i: int, contact: Contact) -> None:
        """Cone, least force and costs of one contact, in the program's units."""
        k = 6 * i  # nature: the size of a wrench
        row = _ROWS * i
        x0, x1, y0, y1 = contact.rectangle
        length = self.length
        inner = Rectangle(x0 / length, x1 / length, y0 / length, y1 / length)
        work.constraints[row : row + 16, k : k + 6] = cone_rows(inner, contact.friction)
        work.constraints[row + 16, k + 2] = -1.0
        work.upper[row + 16] = -self.minimum_force / self.weight
        if len(work.contacts) > 1:
            # Moments about the preferred point: tx - y fz and ty + x fz.
            x, y = contact.preferred or contact.rectangle.center
            x = x / length
            y = y / length
            ankle = self.weights.ankle
            own = work.own
            own[k + 2, k + 2] = ankle * (x * x + y * y)
            own[k + 2, k + 3] = -ankle * y
            own[k + 3, k + 2] = -ankle * y
            own[k + 2, k + 4] = ankle * x
            own[k + 4, k + 2] = ankle * x
            own[k + 3, k + 3] = ankle
            own[k + 4, k + 4] = ankle

    def _least_violating(self, work: _Workspace) -> NDArray[np.float64]:
        """Solution (n,) of the least squared violations, then the least cost."""
        m, n = work.constraints.shape
        hessian = np.diag([_RIDGE] * n + [1.0] * m)
        widened = np.hstack([work.constraints, -np.eye(m)])  # A v - violation <= b
        violations = daqp.solve(hessian, np.zeros(n + m), widened, work.upper, work.lower)[0][n:]
        # derived: a thousand times the solver's tolerance, so that the relaxed program has a solution
        relaxed = work.upper + np.maximum(violations, 0.0) + 1e-7
        return np.asarray(daqp.solve(work.hessian, work.gradient, work.constraints, relaxed, work.lower)[0])

    def _rest(self, contacts: Contacts, shares: tuple[float, ...]) -> WrenchShare:
        parts = [max(0.0, share) for share in shares]
        total = sum(parts)
        if not (math.isfinite(sum(shares)) and total > 0.0):
            parts = [1.0] * len(shares)
            total = float(len(shares))
        wrenches = {}
        for (name, contact), part in zip(contacts.items(), parts, strict=True):
            x, y = contact.preferred or contact.rectangle.center
            x, y = (x, y) if math.isfinite(x + y) else (0.0, 0.0)
            wrenches[name] = part / total * self.weight * np.array([0.0, 0.0, 1.0, y, -x, 0.0])
        return WrenchShare(DistributionState.INVALID, wrenches, np.full(6, np.nan), 0.0)


def _plain(numbers: NDArray[np.float64] | Sequence[float]) -> Sequence[float]:
    if type(numbers) is tuple:
        return numbers
    plain: list[float] = np.asarray(numbers, dtype=float).tolist()
    return plain


def _in_order(contacts: Contacts, shares: Mapping[str, float] | None) -> tuple[float, ...]:
    if shares is None:
        return (1.0 / len(contacts),) * len(contacts)
    found = [shares[name] for name in contacts if name in shares]
    if len(found) != len(contacts) or len(found) != len(shares):
        raise InputError(f"shares are given for {', '.join(shares) or 'nothing'}; allowed: for {', '.join(contacts)}")
    return tuple(found)
