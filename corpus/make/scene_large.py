"""Writes an Inventor scene of loose, partly trimmed spline surfaces: a wavy body like a car's, for the bench
of sewing.

    python corpus/make/scene_large.py OUT.iv [--surfaces 4000] [--gap 2e-5]

The body is one smooth function of a grid of cells. Each cell is a bicubic patch of its own that interpolates
the function at sixteen places, so that neighbours meet within a few micrometres but share nothing. Of every
twenty cells two are larger than their cell and trimmed back to it, one is cut in two along a wave by a
spline, one has a round hole. `--gap` moves each patch by a random amount (metres). The file is the same for
the same arguments.
"""

from __future__ import annotations

import argparse
import math
import random
from collections.abc import Callable, Iterable
from pathlib import Path

Point = tuple[float, float, float]

# Bézier ordinates of the cubic through values at 0, 1/3, 2/3 and 1.
INTERPOLATE = [[1, 0, 0, 0], [-5 / 6, 3, -3 / 2, 1 / 3], [1 / 3, -3 / 2, 3, -5 / 6], [0, 0, 0, 1]]
# How far a trimmed patch reaches beyond its cell, as a share of the cell.
MARGIN = 0.15
SIN45 = math.sqrt(0.5)


def body(s: float, t: float) -> Point:
    """The body (metres): s from tail to nose, t once round; 4.5 m long, 1.8 m wide."""
    a = 2 * math.pi * (1 - t)
    cabin = math.exp(-(((s - 0.47) / 0.2) ** 2))
    ends = math.sin(math.pi * (0.1 + 0.8 * s)) ** 0.5
    width = 0.9 * ends * (1 - 0.12 * cabin * max(0.0, math.sin(a)) ** 2)
    height = (0.38 + (0.34 * cabin if math.sin(a) > 0 else 0.0) * math.sin(a) ** 2) * ends
    ripple = 1 + 0.004 * math.sin(9 * a) * math.sin(40 * s)
    box = 1 + 0.1 * math.cos(4 * a - math.pi)
    return (4.5 * (s - 0.5), width * math.cos(a) * box * ripple, height * math.sin(a) * box * ripple)


def patch(f: Callable[[float, float], Point]) -> list[Point]:
    """The bicubic net, u fastest, that interpolates `f` over the unit square."""
    values = [[f(i / 3, j / 3) for i in range(4)] for j in range(4)]
    rows = [[_blend(INTERPOLATE[i], row) for i in range(4)] for row in values]
    return [_blend(INTERPOLATE[j], [row[i] for row in rows]) for j in range(4) for i in range(4)]


def _blend(weights: list[float], points: list[Point]) -> Point:
    return tuple(sum(w * p[k] for w, p in zip(weights, points)) for k in range(3))


def _numbers(points: Iterable[tuple[float, ...]]) -> str:
    return ", ".join(" ".join(f"{x:.7g}" for x in p) for p in points)


def _surface(net: list[Point], trims: str = "") -> str:
    knots = "[ 0 0 0 0 1 1 1 1 ]"
    return (
        f"Separator {{ Coordinate3 {{ point [ {_numbers(net)} ] }}\n{trims}"
        f"NurbsSurface {{ numUControlPoints 4 numVControlPoints 4 uKnotVector {knots} vKnotVector {knots} }} }}\n"
    )


def _outline(points: list[tuple[float, float]]) -> str:
    index = " ".join(map(str, [*range(len(points)), 0]))
    return f"ProfileCoordinate2 {{ point [ {_numbers(points)} ] }} LinearProfile {{ index [ {index} ] }}\n"


def enlarged(cell: Callable[[float, float], Point]) -> str:
    """A patch that reaches beyond its cell, trimmed back."""
    size = 1 + 2 * MARGIN
    a, b = MARGIN / size, 1 - MARGIN / size
    net = patch(lambda u, v: cell(u * size - MARGIN, v * size - MARGIN))
    return _surface(net, _outline([(a, a), (b, a), (b, b), (a, b)]))


def divided(net: list[Point]) -> list[str]:
    """Two surfaces with the same net on either side of a wave, which is a cubic spline."""
    wave = [(0.0, 0.5), (0.35, 0.72), (0.65, 0.28), (1.0, 0.5)]
    halves = []
    for corners in [[(1.0, 0.0), (0.0, 0.0)], [(1.0, 1.0), (0.0, 1.0)]]:
        points = [*wave, *corners]
        trims = (
            f"ProfileCoordinate2 {{ point [ {_numbers(points)} ] }}\n"
            "NurbsProfile { index [ 0 1 2 3 ] knotVector [ 0 0 0 0 1 1 1 1 ] }\n"
            "LinearProfile { index [ 3 4 5 0 ] linkage ADD_TO_CURRENT }\n"
        )
        halves.append(_surface(net, trims))
    return halves


def pierced(net: list[Point]) -> str:
    """A round hole in a patch: a rational circle inside the border of the square."""
    r = 0.27
    ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    weights = [1 if i % 2 == 0 else SIN45 for i in range(9)]
    points = [((0.5 + r * x) * w, (0.5 + r * y) * w, w) for (x, y), w in zip(ring, weights)]
    trims = (
        _outline([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
        + f"ProfileCoordinate3 {{ point [ {_numbers(points)} ] }}\n"
        "NurbsProfile { index [ 0 1 2 3 4 5 6 7 8 ] linkage START_NEW "
        "knotVector [ 0 0 0 1 1 2 2 3 3 4 4 4 ] }\n"
    )
    return _surface(net, trims)


def scene(surfaces: int, gap: float) -> tuple[str, int]:
    """The file's text and the number of surfaces in it."""
    cells = surfaces / 1.05
    around = max(4, round(math.sqrt(cells / 1.8)))
    along = max(2, math.ceil(cells / around))
    chance = random.Random(4419)
    found: list[str] = []
    for i in range(along):
        for j in range(around):
            if len(found) >= surfaces:
                break
            shift = tuple(gap * (2 * chance.random() - 1) for _ in range(3))

            def cell(u: float, v: float, i: int = i, j: int = j, shift: Point = shift) -> Point:
                p = body((i + u) / along, (j + v) / around)
                return tuple(a + b for a, b in zip(p, shift))

            kind = (i * around + j) % 20
            if kind in (3, 13):
                found.append(enlarged(cell))
            elif kind == 7 and len(found) + 2 <= surfaces:
                found.extend(divided(patch(cell)))
            elif kind == 17:
                found.append(pierced(patch(cell)))
            else:
                found.append(_surface(patch(cell)))
    return "#Inventor V2.1 ascii\n\nSeparator {\n" + "".join(found) + "}\n", len(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--surfaces", type=int, default=4000)
    parser.add_argument("--gap", type=float, default=2e-5)
    given = parser.parse_args()
    text, count = scene(given.surfaces, given.gap)
    given.out.write_text(text, encoding="ascii", newline="\n")
    print(f"{given.out}: {count} surfaces, {len(text) / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
