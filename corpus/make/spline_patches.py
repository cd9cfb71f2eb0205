"""Rational splines of lines, circular arcs and patches of surfaces of revolution, in STEP."""

from __future__ import annotations

import math
from collections.abc import Sequence

from part21 import Point, Step
from rings import Frame, Ring

Place = Sequence[float]


def meridian_arc(ring: Ring, v0: float, v1: float) -> tuple[list[tuple[float, float]], list[float]]:
    """The profile from v0 to v1 as a conic: (radius, height) of three points, and weights."""
    start, end = (ring.rho(v0), ring.height(v0)), (ring.rho(v1), ring.height(v1))
    if ring.meridian is None:
        return [start, ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2), end], [1.0, 1.0, 1.0]
    a, b, r = ring.meridian
    half = (v1 - v0) / 2
    reach, middle = abs(r) / math.cos(half) * math.copysign(1, r), (v0 + v1) / 2
    return [start, (a + reach * math.cos(middle), b + reach * math.sin(middle)), end], [1.0, math.cos(half), 1.0]


def arc(ring: Ring, f: Frame, a: Place, b: Place) -> tuple[list[Point], list[float]]:
    """The line of constant u or constant v between two places, as a conic."""
    if abs(a[0] - b[0]) < 1e-12:
        profile, weights = meridian_arc(ring, a[1], b[1])
        c, s = math.cos(a[0]), math.sin(a[0])
        return [f.at(rho * c, rho * s, z) for rho, z in profile], weights
    half, middle = (b[0] - a[0]) / 2, (a[0] + b[0]) / 2
    rho, z = ring.rho(a[1]), ring.height(a[1])
    far = rho / math.cos(half)
    inner = f.at(far * math.cos(middle), far * math.sin(middle), z)
    return [ring.point(f, *a), inner, ring.point(f, *b)], [1.0, math.cos(half), 1.0]


def conic(s: Step, points: Sequence[Point], weights: Sequence[float]) -> str:
    """A quadratic spline of one or more conics in a row."""
    count = (len(points) - 1) // 2
    knots, multiplicities = [float(k) for k in range(count + 1)], [3] + [2] * (count - 1) + [3]
    if all(w == 1.0 for w in weights):
        return s.spline(2, points, knots, multiplicities)
    return s.spline(2, points, knots, multiplicities, weights=weights)


def rational_patch(s: Step, f: Frame, ring: Ring, u: tuple[float, float], v: tuple[float, float]) -> str:
    """The rectangle of parameters of a ring as a biquadratic rational patch."""
    profile, weights_v = meridian_arc(ring, *v)
    half, middle = (u[1] - u[0]) / 2, (u[0] + u[1]) / 2
    across = [(math.cos(u[0]), math.sin(u[0]), 1.0),
              (math.cos(middle) / math.cos(half), math.sin(middle) / math.cos(half), math.cos(half)),
              (math.cos(u[1]), math.sin(u[1]), 1.0)]
    net = [[f.at(rho * c, rho * sn, z) for rho, z in profile] for c, sn, _ in across]
    weights = [[w * wv for wv in weights_v] for _, _, w in across]
    ends = ([0.0, 1.0], [3, 3])
    return s.spline_surface((2, 2), net, ends, ends, weights=weights)
