"""B-spline surfaces: points, derivatives and areas."""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from dataclasses import dataclass

GAUSS = [(-0.9061798459386640, 0.2369268850561891), (-0.5384693101056831, 0.4786286704993665),
         (0.0, 0.5688888888888889), (0.5384693101056831, 0.4786286704993665),
         (0.9061798459386640, 0.2369268850561891)]


def clamped(degree: int, count: int) -> list[float]:
    """Knots 0, 1, 2 ... for `count` control points."""
    inner = count - degree - 1
    return [0.0] * (degree + 1) + [float(k + 1) for k in range(inner)] + [float(inner + 1)] * (degree + 1)


def basis(knots: Sequence[float], degree: int, t: float) -> tuple[int, list[float], list[float]]:
    """The first control point that counts at t, the basis functions there and their derivatives."""
    n = len(knots) - degree - 1
    span = min(max(bisect.bisect_right(knots, t) - 1, degree), n - 1)
    while knots[span] == knots[span + 1] and span > degree:
        span -= 1

    def functions(p: int) -> list[float]:
        values = [1.0]
        for d in range(1, p + 1):
            new = [0.0] * (d + 1)
            for k, value in enumerate(values):
                i = span - d + 1 + k
                low, high = knots[i], knots[i + d]
                share = (t - low) / (high - low) if high > low else 0.0
                new[k] += (1 - share) * value
                new[k + 1] += share * value
            values = new
        return values

    rates = [0.0] * (degree + 1)
    if degree:
        for k, value in enumerate(functions(degree - 1)):
            i = span - degree + 1 + k
            length = knots[i + degree] - knots[i]
            if length > 0:
                rates[k] -= degree * value / length
                rates[k + 1] += degree * value / length
    return span - degree, functions(degree), rates


@dataclass
class Net:
    """A B-spline surface; `points[i][j]`: i runs with u."""

    degrees: tuple[int, int]
    knots: tuple[list[float], list[float]]
    points: list[list[Sequence[float]]]
    weights: list[list[float]]

    def size(self) -> float:
        flat = [p for row in self.points for p in row]
        return max(math.dist(p, flat[0]) for p in flat)

    def side(self, k: int) -> tuple[list[Sequence[float]], int, list[float], list[float], bool]:
        """Points, degree, knots and weights of side k, and whether the border runs with it."""
        column = lambda table, j: [row[j] for row in table]
        if k in (0, 2):
            j = 0 if k == 0 else -1
            return column(self.points, j), self.degrees[0], self.knots[0], column(self.weights, j), k == 0
        i = -1 if k == 1 else 0
        return list(self.points[i]), self.degrees[1], self.knots[1], list(self.weights[i]), k == 1

    def density(self, u: float, v: float) -> float:
        """Area per area of parameters."""
        i0, nu, du = basis(self.knots[0], self.degrees[0], u)
        j0, nv, dv = basis(self.knots[1], self.degrees[1], v)
        sums = [[0.0] * 4 for _ in range(3)]
        for a in range(len(nu)):
            for b in range(len(nv)):
                w = self.weights[i0 + a][j0 + b]
                p = self.points[i0 + a][j0 + b]
                for total, share in zip(sums, (nu[a] * nv[b], du[a] * nv[b], nu[a] * dv[b])):
                    for c in range(3):
                        total[c] += share * w * p[c]
                    total[3] += share * w
        value, *rates = sums
        x = [c / value[3] for c in value[:3]]
        su, sv = ([(r[c] - r[3] * x[c]) / value[3] for c in range(3)] for r in rates)
        return math.hypot(su[1] * sv[2] - su[2] * sv[1], su[2] * sv[0] - su[0] * sv[2], su[0] * sv[1] - su[1] * sv[0])

    def area(self) -> float:
        total = 0.0
        spans = [[(a, b) for a, b in zip(k, k[1:]) if b - a > 1e-6 * (k[-1] - k[0])] for k in self.knots]
        parts = 2
        for u0, u1 in spans[0]:
            for v0, v1 in spans[1]:
                hu, hv = (u1 - u0) / parts, (v1 - v0) / parts
                for i in range(parts):
                    for j in range(parts):
                        for x, wx in GAUSS:
                            for y, wy in GAUSS:
                                u, v = u0 + hu * (i + 0.5 + 0.5 * x), v0 + hv * (j + 0.5 + 0.5 * y)
                                total += 0.25 * wx * wy * hu * hv * self.density(u, v)
        return total
