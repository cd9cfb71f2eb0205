"""Faces of splines that degenerate: spans of no length, collapsed and folded sides, poles, long flanks.

    python corpus/make/spline_faces.py                    # writes corpus/splines/ and its INDEX.tsv
    python corpus/make/spline_faces.py --variants OUT N   # N random variants of each kind, with their right areas

Each face is a whole spline patch with its own sides as edges. Areas are integrals by Gauss's points over
the spans of the knots.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from pathlib import Path

from part21 import Point, Step, Use, write_sheet
from rings import TAU, Frame, Model, turned
from splines import Net, clamped
from variants import main

FOLDER = Path(__file__).resolve().parent.parent / "splines"

# -- a face over the whole of a patch


def run_lengths(knots: Sequence[float]) -> tuple[list[float], list[int]]:
    values: list[float] = []
    counts: list[int] = []
    for k in knots:
        if values and k == values[-1]:
            counts[-1] += 1
        else:
            values.append(k)
            counts.append(1)
    return values, counts


def side(s: Step, net: Net, k: int) -> Use | None:
    """Side k of a patch, counter-clockwise; none where it is a point."""
    row, degree, knots, weights, forward = net.side(k)
    if all(math.dist(p, row[0]) < 1e-14 * net.size() for p in row):
        return None
    values, counts = run_lengths(knots)
    w = None if all(x == 1.0 for x in weights) else weights
    return s.edge(row[0], row[-1], s.spline(degree, row, values, counts, weights=w)), forward


def surface(s: Step, net: Net) -> str:
    flat = all(w == 1.0 for row in net.weights for w in row)
    return s.spline_surface(net.degrees, net.points, run_lengths(net.knots[0]), run_lengths(net.knots[1]),
                            weights=None if flat else net.weights)


def whole(net: Net, rng: random.Random, uncertainty: float = 1e-6) -> Model:
    against = rng.random() < 0.3
    start = rng.randrange(4)

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=uncertainty)
        uses = [use for k in range(4) if (use := side(s, net, (start + k) % 4))]
        if against:
            uses = [(e, not f) for e, f in reversed(uses)]
        bounds = [s.bound(s.loop(uses), outer=True)]
        write_sheet(s, [s.face(bounds, surface(s, net), not against)], path)

    return "", net.area(), write


# -- nets


def wavy(rng: random.Random, nu: int, nv: int, size: float, height: float) -> list[list[list[float]]]:
    a, b, c = (rng.uniform(0.5, 3) for _ in range(3))
    at = lambda x, y: height * size * (math.sin(a * x + b * y) + 0.5 * math.cos(c * x * y))
    return [[[size * i / (nu - 1), size * j / (nv - 1), at(i / (nu - 1), j / (nv - 1))] for j in range(nv)]
            for i in range(nu)]


def placed(points: Sequence[Sequence[Sequence[float]]], f: Frame) -> list[list[Point]]:
    return [[f.at(*p) for p in row] for row in points]


def made(points: Sequence[Sequence[Sequence[float]]], degrees: tuple[int, int], rng: random.Random,
         knots: tuple[list[float], list[float]] | None = None, weights: list[list[float]] | None = None) -> Net:
    count = (len(points), len(points[0]))
    weights = weights or [[1.0] * count[1] for _ in range(count[0])]
    return Net(degrees, knots or (clamped(degrees[0], count[0]), clamped(degrees[1], count[1])),
               placed(points, turned(rng)), weights)


def scale(rng: random.Random) -> float:
    return 10 ** rng.uniform(-1, 3)


# -- the kinds


def no_span(rng: random.Random) -> Model:
    """Knots that differ by rounding, or that are so many that spans have no length; points as Bezier pieces."""
    degree, pieces = rng.choice([2, 3, 5]), rng.randrange(2, 5)
    across = rng.choice([1, 2, 3])
    nu, nv = degree * pieces + 1, across + 1 + rng.randrange(3)
    knots = [0.0] * (degree + 1)
    for k in range(1, pieces):
        at = float(k)
        gap = rng.choice([0.0, 1e-15, 1e-12, 1e-9, 1e-7])
        knots += [at + gap * i for i in range(degree)]
    knots += [float(pieces)] * (degree + 1)
    points = wavy(rng, nu, nv, scale(rng), rng.uniform(0, 0.2))
    return whole(made(points, (degree, across), rng, (knots, clamped(across, nv))), rng)


def stacked(rng: random.Random) -> Model:
    """Rows of control points that coincide, or nearly: parts of the patch have no area."""
    degree = rng.choice([2, 3])
    n = degree + 1 + rng.randrange(2, 6)
    points = wavy(rng, n, 4, scale(rng), rng.uniform(0, 0.2))
    first = rng.randrange(0, n - degree)
    count = rng.randrange(2, degree + 2)
    off = rng.choice([0.0, 0.0, 1e-12, 1e-8])
    for i in range(first + 1, min(first + count, n)):
        points[i] = [[c + off * (i - first) * d for c, d in zip(p, (1, 0, 0))] for p in points[first]]
    return whole(made(points, (degree, 3), rng), rng)


def collapsed(rng: random.Random) -> Model:
    """One or two sides that are a point, or so short that they are one within the accuracy."""
    degree = rng.choice([1, 2, 3])
    n, m = degree + 1 + rng.randrange(3), 4 + rng.randrange(3)
    size = scale(rng)
    points = wavy(rng, n, m, size, rng.uniform(0, 0.2))
    off = rng.choice([0.0, 0.0, 1e-10, 1e-8, 1e-6]) * size
    ends = rng.choice([[0], [m - 1], [0, m - 1]])
    for j in ends:
        middle = [sum(row[j][c] for row in points) / n for c in range(3)]
        for i, row in enumerate(points):
            row[j] = [m + off * (c - m) / size for c, m in zip(row[j], middle)]
    return whole(made(points, (degree, 3), rng), rng)


def folded_side(rng: random.Random) -> Model:
    """A side that runs out and back on the same way."""
    size = scale(rng)
    n = 3 + 2 * rng.randrange(2)
    points = wavy(rng, n, 4, size, rng.uniform(0, 0.1))
    middle = n // 2
    for i in range(middle + 1, n):
        points[i][0] = list(points[n - 1 - i][0])
    return whole(made(points, (2, 3), rng), rng)


def disc(rng: random.Random) -> Model:
    """A disc on four sides: at its corners both directions are the same."""
    r, half = scale(rng), math.sqrt(0.5)
    dome = rng.choice([0.0, 0.0, rng.uniform(0.05, 0.4)])
    ring = [[(-half, -half), (0, -2 * half), (half, -half)], [(-2 * half, 0), (0, 0), (2 * half, 0)],
            [(-half, half), (0, 2 * half), (half, half)]]
    weights = [[1.0, half, 1.0], [half, 1.0, half], [1.0, half, 1.0]]
    points = [[[r * ring[j][i][0], r * ring[j][i][1], dome * r if i == j == 1 else 0.0] for j in range(3)]
              for i in range(3)]
    return whole(made(points, (2, 2), rng, weights=weights), rng)


def straight_corner(rng: random.Random) -> Model:
    """A triangle as a patch of four sides: two of them are one line."""
    size = scale(rng)
    x = rng.uniform(0.2, 0.8)
    corners = [(0, 0), (x, 0), (1, 0), (rng.uniform(0, 1), rng.uniform(0.3, 1))]
    n = rng.choice([2, 3, 4])
    height = rng.choice([0.0, rng.uniform(0, 0.2)])

    def at(u: float, v: float) -> list[float]:
        w = [(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v]
        p = [sum(a * c[k] for a, c in zip(w, corners)) for k in range(2)]
        return [size * p[0], size * p[1], height * size * u * (1 - u) * v * (1 - v) * 16]

    points = [[at(i / (n - 1), j / (n - 1)) for j in range(n)] for i in range(n)]
    return whole(made(points, (n - 1, n - 1), rng), rng)


def flank(rng: random.Random) -> Model:
    """A long flank of a screw: two helices and straight lines between them."""
    r0 = scale(rng)
    r1 = r0 * rng.uniform(1.05, 1.6)
    turns, pitch = rng.uniform(1.5, 25), r0 * rng.uniform(0.3, 3)
    lean = rng.uniform(-0.4, 0.4) * pitch
    per_turn = rng.choice([6, 8, 12])
    n = max(4, round(turns * per_turn))
    rows = []
    for i in range(n):
        a = TAU * turns * i / (n - 1)
        z = pitch * a / TAU
        rows.append([[r0 * math.cos(a), r0 * math.sin(a), z], [r1 * math.cos(a), r1 * math.sin(a), z + lean]])
    if rng.random() < 0.5:
        rows = [list(row) for row in zip(*rows)]
        return whole(made(rows, (1, 3), rng), rng)
    return whole(made(rows, (3, 1), rng), rng)


def thread(rng: random.Random) -> Model:
    """The same as Bezier pieces of a rational helix tube: a band of a thread's side."""
    r, height = scale(rng), rng.uniform(0.05, 0.6)
    turns, pitch = rng.uniform(1, 12), rng.uniform(0.3, 3)
    pieces = max(2, math.ceil(4 * turns))
    step = TAU * turns / pieces
    weight = math.cos(step / 2)
    rows, weights, knots = [], [], [0.0] * 3
    for k in range(2 * pieces + 1):
        a = step * k / 2
        far = r / (weight if k % 2 else 1.0)
        z = r * pitch * a / TAU
        rows.append([[far * math.cos(a), far * math.sin(a), z], [far * math.cos(a), far * math.sin(a), z + height * r]])
        weights.append([weight if k % 2 else 1.0] * 2)
    for k in range(1, pieces):
        knots += [float(k)] * 2
    knots += [float(pieces)] * 3
    return whole(made(rows, (2, 1), rng, (knots, [0.0, 0.0, 1.0, 1.0]), weights), rng)


def loose_sides(rng: random.Random) -> Model:
    """A patch whose edges are off its sides by a little more or less than the accuracy."""
    size = scale(rng)
    degree = rng.choice([2, 3])
    points = wavy(rng, degree + 1 + rng.randrange(3), 4, size, rng.uniform(0, 0.2))
    net = made(points, (degree, 3), rng)
    off = size * 10 ** rng.uniform(-7, -3)
    uncertainty = off * 10 ** rng.uniform(-2, 1)

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=uncertainty)
        corners: dict[tuple[float, ...], list[float]] = {}

        def moved(p: Point) -> list[float]:
            return corners.setdefault(tuple(p), [c + off * rng.uniform(-1, 1) for c in p])

        uses = []
        for k in range(4):
            row, degree, knots, _, forward = net.side(k)
            loose = [moved(row[0]), *[[c + off * rng.uniform(-1, 1) for c in p] for p in row[1:-1]], moved(row[-1])]
            uses.append((s.edge(loose[0], loose[-1], s.spline(degree, loose, *run_lengths(knots))), forward))
        write_sheet(s, [s.face([s.bound(s.loop(uses), outer=True)], surface(s, net))], path)

    return "", net.area(), write


def tiny_neighbours(rng: random.Random) -> Model:
    """A large patch, and beside it a tiny strip of its own surface's continuation cut into tiny faces."""
    size = scale(rng)
    share = 10 ** rng.uniform(-4, -1.5)
    n = rng.randrange(2, 5)
    bend = rng.uniform(-0.3, 0.3)
    f = turned(rng)

    def at(x: float, y: float) -> Point:
        return f.at(size * x, size * y, size * (0.2 * math.sin(2 * y) + bend * x * x))

    def net(x0: float, x1: float, y0: float, y1: float) -> Net:
        points = [[at(x0 + (x1 - x0) * i / 3, y0 + (y1 - y0) * j / 3) for j in range(4)] for i in range(4)]
        return Net((3, 3), (clamped(3, 4), clamped(3, 4)), points, [[1.0] * 4 for _ in range(4)])

    # Sides of neighbours are the same curves, for every row of control points runs along one line of x or y.
    cuts = sorted(rng.uniform(0.1, 0.9) for _ in range(n - 1))
    ys = [0.0, *cuts, 1.0]
    nets = [net(1.0, 1.0 + share, a, b) for a, b in zip(ys, ys[1:])]
    total = sum(part.area() for part in nets)

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=1e-6)
        edges: dict[tuple, Use] = {}
        faces = []
        for part in nets:
            uses = []
            for k in range(4):
                row, degree, knots, _, forward = part.side(k)
                key = (tuple(row[0]), tuple(row[-1]))
                if key not in edges:
                    edges[key] = (s.edge(row[0], row[-1], s.spline(degree, row, *run_lengths(knots))), forward)
                uses.append((edges[key][0], forward))
            faces.append(s.face([s.bound(s.loop(uses), outer=True)], surface(s, part)))
        write_sheet(s, faces, path)

    return "", total, write


KINDS: dict[str, tuple[str, Callable[[random.Random], Model]]] = {
    "no_span": ("knot spans of no length, by rounding or multiplicity", no_span),
    "stacked": ("rows of control points that coincide", stacked),
    "collapsed": ("sides that are a point, or nearly", collapsed),
    "folded_side": ("a side that runs out and back on the same way", folded_side),
    "disc": ("a disc on four sides", disc),
    "straight_corner": ("a triangle as a patch of four sides", straight_corner),
    "flank": ("a long flank of a screw", flank),
    "thread": ("a long band round a cylinder, rational pieces", thread),
    "loose_sides": ("edges off the sides of their patch", loose_sides),
    "tiny_neighbours": ("a thin strip cut into tiny faces", tiny_neighbours),
}

if __name__ == "__main__":
    main(__doc__, FOLDER, KINDS, kept=2)
