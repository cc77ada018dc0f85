"""Quadratic program that shares a net wrench between contacts."""

import math

import numpy as np

from ..base import memory

__all__ = ["WrenchProgram"]


class WrenchProgram:
    """Program of n contacts, in its units; fills the caller's arrays.

    Args:
        scales: Weight of robot in N, unit of moments over forces in m, costs of net wrench, of proportion of normal
            forces and of that of horizontal ones.
        unit: Unit of each unknown (6 n,) in N and N m, contact by contact.
        jacobian: Receives map (6, 6 n) from unknowns to net wrench about contacts' middle.
        fixed: Part of Hessian (6 n, 6 n) that does not depend on shares, filled by caller.
        hessian: Receives Hessian (6 n, 6 n).
        wanted: Receives wanted net wrench (6,) about middle of contacts.
        gradient: Gradient (6 n,) but for a factor, filled by caller.
    """

    def __init__(self, scales, unit, jacobian, fixed, hessian, wanted, gradient):
        self.weight, self.length, self.net, self.pressure, self.horizontal = scales
        self.unit = unit
        self.jacobian = jacobian
        self.fixed = fixed
        self.hessian = hessian
        self.wanted = wanted
        self.gradient = gradient
        count = len(unit) // 6
        self.positions = np.zeros((count, 3))
        self.rotations = np.zeros((count, 3, 3))
        self.wished = np.zeros(count)
        self.shares = np.zeros(count)
        self.request = np.zeros(9)
        self.middle = np.zeros(3)
        self.factor = np.zeros((len(unit), len(unit)))
        self.factored = False

    def ask(self, wrench, point, shares):
        """Set a request; returns whether it is finite, with some share above 0.

        `wrench`: wanted net wrench, six numbers in N and N m in world frame about `point` in m.
        """
        request = self.request
        fx, fy, fz, tx, ty, tz = wrench
        px, py, pz = point
        request[0] = fx
        request[1] = fy
        request[2] = fz
        request[3] = tx
        request[4] = ty
        request[5] = tz
        request[6] = px
        request[7] = py
        request[8] = pz
        total = fx + fy + fz + tx + ty + tz + px + py + pz
        some = 0.0
        for i in range(self.wished.shape[0]):
            share = shares[i]
            self.wished[i] = share
            some += share
        return math.isfinite(total + some) and some > 0.0

    def place(self, i, position, rotation):
        """Place contact `i` at a position (3,) in m and rotation (3, 3) to world; returns whether it moved."""
        moved = False
        for j in range(3):
            moved = moved or self.positions[i, j] != position[j]
            self.positions[i, j] = position[j]
            for k in range(3):
                moved = moved or self.rotations[i, j, k] != rotation[j, k]
                self.rotations[i, j, k] = rotation[j, k]
        return moved

    def turn(self):
        """Fill the Jacobian for the contacts' places; returns whether it is finite."""
        positions = self.positions
        rotations = self.rotations
        jacobian = self.jacobian
        middle = self.middle
        count = positions.shape[0]
        total = 0.0
        for i in range(count):
            for j in range(3):
                if not math.isfinite(positions[i, j]):
                    return False
                for k in range(3):
                    if not math.isfinite(rotations[i, j, k]):
                        return False
        for j in range(3):
            middle[j] = 0.0
            for i in range(count):
                middle[j] += positions[i, j]
            middle[j] /= count
        for i in range(count):
            dx = (positions[i, 0] - middle[0]) / self.length
            dy = (positions[i, 1] - middle[1]) / self.length
            dz = (positions[i, 2] - middle[2]) / self.length
            for k in range(3):
                x = rotations[i, 0, k]
                y = rotations[i, 1, k]
                z = rotations[i, 2, k]
                c = 6 * i + k
                jacobian[0, c] = x
                jacobian[3, c + 3] = x
                jacobian[1, c] = y
                jacobian[4, c + 3] = y
                jacobian[2, c] = z
                jacobian[5, c + 3] = z
                jacobian[3, c] = dy * z - dz * y
                jacobian[4, c] = dz * x - dx * z
                jacobian[5, c] = dx * y - dy * x
                total += x + y + z + jacobian[3, c] + jacobian[4, c] + jacobian[5, c]
        return math.isfinite(total)

    def weigh(self, renewed):
        """Fill the Hessian for the requested shares; returns whether it changed."""
        hessian = self.hessian
        shares = self.shares
        count = self.shares.shape[0]
        for i in range(count):
            renewed = renewed or shares[i] != self.wished[i]
            shares[i] = self.wished[i]
        if not renewed:
            return False
        self.factored = False
        for a in range(6 * count):
            for b in range(6 * count):
                hessian[a, b] = self.fixed[a, b]
        for i in range(count):
            for j in range(i + 1, count):
                a = 6 * i + 2
                b = 6 * j + 2
                one = shares[i]
                other = shares[j]
                hessian[a, a] += self.pressure * other * other
                hessian[b, b] += self.pressure * one * one
                hessian[a, b] -= self.pressure * one * other
                hessian[b, a] -= self.pressure * one * other
                self._level(i, j, self.horizontal)
        return True

    def _level(self, i, j, cost):
        """Add the cost of horizontal forces of contacts `i` and `j` that are not in proportion of their shares."""
        hessian = self.hessian
        rotations = self.rotations
        one = self.shares[i]
        other = self.shares[j]
        for a in range(3):
            for b in range(3):
                own = rotations[i, 0, a] * rotations[i, 0, b] + rotations[i, 1, a] * rotations[i, 1, b]
                its = rotations[j, 0, a] * rotations[j, 0, b] + rotations[j, 1, a] * rotations[j, 1, b]
                both = rotations[i, 0, a] * rotations[j, 0, b] + rotations[i, 1, a] * rotations[j, 1, b]
                hessian[6 * i + a, 6 * i + b] += cost * other * other * own
                hessian[6 * j + a, 6 * j + b] += cost * one * one * its
                hessian[6 * i + a, 6 * j + b] -= cost * one * other * both
                hessian[6 * j + b, 6 * i + a] -= cost * one * other * both

    def aim(self):
        """Fill the wanted net wrench about the middle of the contacts."""
        request = self.request
        middle = self.middle
        wanted = self.wanted
        fx = request[0]
        fy = request[1]
        fz = request[2]
        tx = request[3]
        ty = request[4]
        tz = request[5]
        dx = request[6] - middle[0]
        dy = request[7] - middle[1]
        dz = request[8] - middle[2]
        force = self.weight
        moment = self.weight * self.length
        wanted[0] = fx / force
        wanted[1] = fy / force
        wanted[2] = fz / force
        wanted[3] = (tx + dy * fz - dz * fy) / moment
        wanted[4] = (ty + dz * fx - dx * fz) / moment
        wanted[5] = (tz + dx * fy - dy * fx) / moment

    def finish_gradient(self):
        """Multiply wanted wrench times Jacobian by its factor, minus the net wrench's cost."""
        for i in range(self.gradient.shape[0]):
            self.gradient[i] *= -self.net

    def least_cost(self, constraints, upper):
        """Unknowns (6 n,) of the least cost where they meet constraints (m, 6 n) with upper bounds (m,), in the
        program's units; None where one is violated, or the Hessian is singular.
        """
        count = self.gradient.shape[0]
        factor = self.factor
        if not self.factored and not self._factorise():
            return None
        found = memory.new_vector(count)
        v = memory.room(found)
        for i in range(count):
            total = -self.gradient[i]
            for j in range(i):
                total -= factor[i, j] * v[j]
            v[i] = total / factor[i, i]
        for i in range(count - 1, -1, -1):
            total = v[i]
            for j in range(i + 1, count):
                total -= factor[j, i] * v[j]
            v[i] = total / factor[i, i]
        for k in range(upper.shape[0]):
            total = 0.0
            for i in range(count):
                total += constraints[k, i] * v[i]
            if not total <= upper[k]:
                return None
        return found

    def _factorise(self):
        """Cholesky factor of the Hessian, once for each; returns whether it is regular."""
        hessian = self.hessian
        factor = self.factor
        for i in range(hessian.shape[0]):
            for j in range(i + 1):
                total = hessian[i, j]
                for k in range(j):
                    total -= factor[i, k] * factor[j, k]
                if i > j:
                    factor[i, j] = total / factor[j, j]
                elif total > 0.0:
                    factor[i, i] = math.sqrt(total)
                else:
                    return False
        self.factored = True
        return True

    def finish(self, unknowns, names):
        """Largest error of a solution (6 n,) in the program's units, NaN if any; net wrench (6,) less the wanted in N
        and N m; and each contact's wrench (6,) by name.
        """
        jacobian = self.jacobian
        wanted = self.wanted
        unit = self.unit
        largest = 0.0
        solution = memory.values(unknowns)
        error = memory.new_vector(6)
        wrenches = {}
        out = memory.room(error)
        for j in range(6):
            off = 0.0
            for i in range(unit.shape[0]):
                off += jacobian[j, i] * solution[i]
            off -= wanted[j]
            out[j] = off * unit[j]
            if not abs(off) <= largest and largest == largest:
                largest = abs(off)
        for i, name in enumerate(names):
            wrenches[name] = memory.new_vector(6)
            out = memory.room(wrenches[name])
            for j in range(6):
                out[j] = solution[6 * i + j] * unit[6 * i + j]
        return largest, error, wrenches
