"""Closed surfaces with windows all round: no straight line leads past them."""

from __future__ import annotations

import math
import random

from rings import TAU, Band, Model, Ring, cone, cylinder, sheet, sphere, torus


def staggered(
    span: tuple[float, float],
    around: int,
    rows: int,
    overlap: float,
    margin: float,
    rng: random.Random | None = None,
) -> list:
    """Rows of windows so wide and so placed that no straight line passes between all of them."""
    windows = []
    step = TAU / around
    pitch = (span[1] - span[0]) / rows
    for row in range(rows):
        first = step * row / rows + (rng.uniform(0, TAU) if rng else 0.1)
        width = step * min(0.93, 1 - 1 / rows + overlap) if rows > 1 else step * 0.8
        low = span[0] + pitch * (row + margin)
        high = span[0] + pitch * (row + 1 - margin)
        windows += [((first + step * k, first + step * k + width), (low, high)) for k in range(around)]
    return windows


def perforated(
    ring: Ring,
    low: float | None,
    high: float | None,
    span: tuple[float, float],
    around: int,
    rows: int,
    inside: tuple[float, float] | None = None,
    rng: random.Random | None = None,
) -> Band:
    return Band(ring, low, high, span, staggered(inside or span, around, rows, 0.2, 0.2, rng))


def tube(rng: random.Random | None) -> Model:
    r = rng.uniform(2, 20) if rng else 10.0
    h = r * (rng.uniform(1, 6) if rng else 3.0)
    around, rows = (rng.randrange(2, 9), rng.randrange(2, 7)) if rng else (5, 4)
    return sheet(
        lambda: [perforated(cylinder(r), 0, h, (0, h), around, rows, rng=rng)],
        rng,
        rng.uniform(0, TAU) if rng else 0.0,
    )


def funnel(rng: random.Random | None) -> Model:
    r = rng.uniform(2, 20) if rng else 10.0
    angle = rng.uniform(0.1, 1.2) if rng else 0.5
    h = r * (rng.uniform(1, 3) if rng else 2.0)
    around, rows = (rng.randrange(2, 9), rng.randrange(2, 7)) if rng else (5, 3)
    return sheet(lambda: [perforated(cone(r, angle), 0, h, (0, h), around, rows, rng=rng)], rng)


def dome(rng: random.Random | None) -> Model:
    """A cap round the pole, with windows all round."""
    r = rng.uniform(2, 20) if rng else 10.0
    low = rng.uniform(-0.8, 0.3) if rng else 0.0
    around, rows = (rng.randrange(2, 9), rng.randrange(1, 5)) if rng else (6, 3)
    return sheet(
        lambda: [perforated(sphere(r), low, None, (low, math.pi / 2), around, rows, (low, 1.35), rng)], rng
    )


def strainer(rng: random.Random | None) -> Model:
    """A whole sphere with windows all round: no loop winds round it."""
    r = rng.uniform(2, 20) if rng else 10.0
    around, rows = (rng.randrange(2, 9), rng.randrange(2, 6)) if rng else (6, 3)
    return sheet(
        lambda: [
            perforated(sphere(r), None, None, (-math.pi / 2, math.pi / 2), around, rows, (-1.3, 1.3), rng)
        ],
        rng,
    )


def ring_band(rng: random.Random | None) -> Model:
    """A band of a torus with windows all round."""
    big, r = (rng.uniform(10, 20), rng.uniform(2, 8)) if rng else (15.0, 6.0)
    a = rng.uniform(-2, 0) if rng else -1.0
    b = a + (rng.uniform(1, 5) if rng else 3.0)
    around, rows = (rng.randrange(2, 9), rng.randrange(2, 5)) if rng else (6, 3)
    return sheet(lambda: [perforated(torus(big, r), a, b, (a, b), around, rows, rng=rng)], rng)


def ring_whole(rng: random.Random | None) -> Model:
    """A whole torus with windows all round one way: no straight cut leads across."""
    big, r = (rng.uniform(10, 20), rng.uniform(2, 8)) if rng else (15.0, 6.0)
    around, rows = (rng.randrange(2, 9), rng.randrange(2, 5)) if rng else (6, 3)
    inside = (0.4, 5.6)
    return sheet(lambda: [perforated(torus(big, r), None, None, (0, TAU), around, rows, inside, rng)], rng)


def ring_blocked(rng: random.Random | None) -> Model:
    """A whole torus with windows so placed that no straight cut leads along it or across."""
    big, r = (rng.uniform(10, 20), rng.uniform(2, 8)) if rng else (15.0, 6.0)
    around, rows = (3 * rng.randrange(1, 4), 3 * rng.randrange(1, 3)) if rng else (6, 3)
    phase = (rng.uniform(0, TAU), rng.uniform(0, TAU)) if rng else (0.3, 0.2)
    step, pitch = TAU / around, TAU / rows
    windows = []
    for row in range(rows):
        for k in range(around):
            # Rows are shifted by thirds along, columns by thirds across: windows half as wide
            # lie in every line.
            low = phase[1] + pitch * (row + (k % 3) / 3)
            first = phase[0] + step * (k - (row % 3) / 3)
            windows.append(((first, first + 0.5 * step), (low, low + 0.5 * pitch)))
    return sheet(lambda: [Band(torus(big, r), None, None, (0, TAU), windows)], rng)
