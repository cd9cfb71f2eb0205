"""Faces of closed surfaces with holes of every shape: whatever cuts them open must keep clear of all loops.

    python corpus/make/charts.py                    # writes corpus/charts/ and its INDEX.tsv
    python corpus/make/charts.py --variants OUT N   # N random variants of each kind, with their right areas

A *layout* is a set of loops in a chart of period 1 in s (and in t, for a torus), with t between 0 and 1. A
kind of surface gives each layout its parameters. All sides are straight in parameters, so that areas are
integrals along the loops.
"""

from __future__ import annotations

import argparse
import json
import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "charts"
TAU = 2 * math.pi

Place = tuple[float, float]
Polygon = list[Place]


# -- layouts


@dataclass
class Layout:
    """Loops of a face that goes round s: borders (None: the surface ends or closes there) and holes."""

    low: Polygon | None
    high: Polygon | None
    holes: list[Polygon] = field(default_factory=list)


def wavy(rng: random.Random, t: float, height: float, inwards: float) -> Polygon:
    """A border that winds once round: from s = 0 to s = 1, the end left out."""
    n = rng.choice([3, 4, 7, 12, 25])
    start = rng.random()
    waves = height * rng.choice([0.0, 0.0, 0.4, 1.0])
    return [(start + k / n, t + inwards * waves * rng.random()) for k in range(n)]


def bricks(rng: random.Random, low: float, high: float, periodic: bool) -> list[Polygon]:
    """Shrunk cells of an uneven wall of bricks all over the chart: what is left is a net of struts."""
    rows, around = rng.randrange(1, 5), rng.randrange(2, 7)
    lean = rng.uniform(-0.5, 0.5)
    jitter = rng.uniform(0.0, 0.18)
    pitch, width = (high - low) / rows, 1 / around
    moved: dict[tuple[int, int, int], Place] = {}

    def corner(row: int, column: int, half: int) -> Place:
        """A point of the lines between the rows; they have points at every half brick."""
        turns, inside = divmod(2 * column + half, 2 * around)
        levels, level = divmod(row, rows) if periodic else (0, row)
        key = (level, inside, 0)
        if key not in moved:
            moved[key] = (rng.uniform(-jitter, jitter) * width, rng.uniform(-jitter, jitter) * pitch)
        ds, dt = moved[key]
        t = low + row * pitch
        s = (2 * column + half) * width / 2 + ds
        if not periodic:
            s += lean * (t - low)
        return s, t + dt

    cells = []
    shrink = rng.choice([0.3, 0.6, 0.85, 0.95])
    for row in range(rows):
        shift = row % 2 if rows % 2 == 0 or not periodic else 0
        for column in range(around):
            if rng.random() < 0.1:
                continue
            below = [corner(row, column, shift + half) for half in range(3)]
            above = [corner(row + 1, column, shift + half) for half in (2, 1, 0)]
            cell = below + above
            cs, ct = (sum(p[k] for p in cell) / 6 for k in range(2))
            cells.append([(cs + shrink * (s - cs), ct + shrink * (t - ct)) for s, t in cell])
    return cells


def slots(rng: random.Random, low: float, high: float) -> list[Polygon]:
    """Narrow slots that run round like threads, up to several turns."""
    count = rng.randrange(1, 4)
    turns = rng.choice([-1, 1]) * rng.uniform(0.6, 2.5)
    share = rng.uniform(0.1, 0.6) / count / max(1.0, abs(turns))
    n = rng.choice([1, 4, 20])
    margin = 0.1 * (high - low)
    lower, upper = low + margin, high - margin
    found = []
    for k in range(count):
        start = k / count
        # Slots are beside each other along s, whichever way they lean.
        line = [(start + turns * i / n, lower + (upper - lower) * i / n) for i in range(n + 1)]
        found.append(line[:] + [(s + share, t) for s, t in reversed(line)])
    return found


def stars(rng: random.Random, low: float, high: float, periodic: bool) -> list[Polygon]:
    """Round holes and stars at random places, as many as fit."""
    found: list[tuple[Place, float]] = []
    aim = rng.choice([1, 2, 5, 12])
    largest = rng.choice([0.07, 0.2, 0.45]) * (high - low)
    for _ in range(200):
        r = largest * rng.uniform(0.3, 1.0)
        if r > 0.48:
            continue
        inside = (low, high) if periodic else (low + 1.05 * r, high - 1.05 * r)
        at = (rng.random(), rng.uniform(*inside))
        across = 1.0 if periodic else None

        def distance(o: Place) -> float:
            return math.hypot(nearest(at[0], o[0], 1.0), nearest(at[1], o[1], across))

        far = all(distance(o) > 1.05 * (r + q) for o, q in found)
        if far and not (periodic and r > 0.45):
            found.append((at, r))
        if len(found) == aim:
            break
    polygons = []
    for (s, t), r in found:
        n = rng.choice([3, 4, 8, 30])
        inner = rng.choice([1.0, 1.0, 0.5])
        angle = rng.uniform(0, TAU)
        radii = [r * (inner if k % 2 else 1.0) for k in range(n)] if n % 2 == 0 else [r] * n
        angles = [angle + TAU * k / n for k in range(n)]
        polygons.append([(s + q * math.cos(a), t + q * math.sin(a)) for a, q in zip(angles, radii)])
    return polygons


def combs(rng: random.Random, low: float, high: float) -> list[Polygon]:
    """Two combs whose teeth go between each other, all round: no straight line passes."""
    teeth = rng.randrange(3, 9)
    width = 1 / teeth
    h = high - low
    back, reach = 0.12 * h, rng.uniform(0.55, 0.68) * h
    gap = rng.uniform(0.08, 0.2) * width
    tooth = width / 2 - gap
    s0 = rng.random()

    def comb(base: float, towards: float, shift: float) -> Polygon:
        # The back leaves a strut of half a tooth, so that the comb is a hole and no border.
        points = [(s0 + shift, base)]
        end = s0 + shift + 1 - width / 2
        outline = []
        for k in range(teeth):
            a = s0 + shift + k * width
            b = min(a + tooth, end)
            outline += [(a, base + towards * reach), (b, base + towards * reach)]
            if k + 1 < teeth:
                outline += [(b, base + towards * back), (a + width, base + towards * back)]
        points = [(s0 + shift, base), *outline, (outline[-1][0], base)]
        return points

    return [comb(low + 0.08 * h, 1.0, 0.0), comb(high - 0.08 * h, -1.0, width / 2)]


def nearest(a: float, b: float, period: float | None) -> float:
    d = a - b
    return d if period is None else d - period * round(d / period)


def holes(rng: random.Random, periodic: bool) -> list[Polygon]:
    low, high = (0.0, 1.0) if periodic else (0.12, 0.88)
    kinds: list[Callable[[], list[Polygon]]] = [
        lambda: bricks(rng, low, high, periodic),
        lambda: bricks(rng, low, high, periodic),
        lambda: stars(rng, low, high, periodic),
        lambda: slots(rng, 0.02 if periodic else low, 0.98 if periodic else high),
        lambda: combs(rng, 0.02 if periodic else low, 0.98 if periodic else high),
        lambda: [],
    ]
    return rng.choices(kinds, [3, 3, 4, 2, 2, 1])[0]()


# -- surfaces


@dataclass
class Round:
    """A surface of revolution: parameters of a place of the chart, density of its area, and its JSON."""

    describe: Callable[[Frame], dict]
    # Density of area in parameters.
    density: Callable[[float, float], float]
    point: Callable[[float, float], tuple[float, float, float]]
    u: Callable[[float], float]
    v: Callable[[float], float]
    poles: tuple[bool, bool] = (False, False)
    periodic: bool = False


@dataclass(frozen=True)
class Frame:
    o: tuple[float, ...]
    x: tuple[float, ...]
    y: tuple[float, ...]
    z: tuple[float, ...]

    def at(self, p: Sequence[float]) -> list[float]:
        a, b, c = p
        return [o + a * x + b * y + c * z for o, x, y, z in zip(self.o, self.x, self.y, self.z)]

    def json(self) -> dict:
        return {"origin": list(self.o), "x": list(self.x), "y": list(self.y), "z": list(self.z)}


def turned(rng: random.Random) -> Frame:
    z = unit([rng.gauss(0, 1) for _ in range(3)])
    x = unit(cross(z, [rng.gauss(0, 1) for _ in range(3)]))
    return Frame(tuple(rng.uniform(-50, 50) for _ in range(3)), tuple(x), tuple(cross(z, x)), tuple(z))


def unit(v: Sequence[float]) -> list[float]:
    length = math.sqrt(sum(c * c for c in v))
    return [c / length for c in v]


def cross(a: Sequence[float], b: Sequence[float]) -> list[float]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def turn(rho: float, u: float, z: float) -> tuple[float, float, float]:
    return rho * math.cos(u), rho * math.sin(u), z


def tube(rng: random.Random) -> Round:
    r, h = 10 ** rng.uniform(0, 1), 10 ** rng.uniform(0.3, 1.5)
    return Round(lambda f: {"cylinder": {"frame": f.json(), "radius": r}}, lambda u, v: r,
                 lambda u, v: turn(r, u, v), lambda s: TAU * s, lambda t: h * t)


def funnel(rng: random.Random, apex: bool = False) -> Round:
    r, h = rng.uniform(2, 10), rng.uniform(2, 15)
    angle = rng.uniform(0.1, 1.3)
    tan, slant = math.tan(angle), 1 / math.cos(angle)
    start = -r / tan if apex else 0.0
    return Round(lambda f: {"cone": {"frame": f.json(), "radius": r, "half_angle": angle}},
                 lambda u, v: slant * (r + v * tan), lambda u, v: turn(r + v * tan, u, v),
                 lambda s: TAU * s, lambda t: start + h * t, poles=(apex, False))


def ball(rng: random.Random, low: bool, high: bool) -> Round:
    r = rng.uniform(2, 10)
    v0 = -math.pi / 2 if low else rng.uniform(-1.45, -0.2)
    v1 = math.pi / 2 if high else rng.uniform(0.2, 1.45)
    return Round(lambda f: {"sphere": {"frame": f.json(), "radius": r}}, lambda u, v: r * r * math.cos(v),
                 lambda u, v: turn(r * math.cos(v), u, r * math.sin(v)),
                 lambda s: TAU * s, lambda t: v0 + (v1 - v0) * t, poles=(low, high))


def doughnut(rng: random.Random, whole: bool) -> Round:
    big, r = rng.uniform(6, 10), rng.uniform(1, 5)
    v0, length = rng.uniform(-4, 4), TAU if whole else rng.uniform(1, 5)
    return Round(lambda f: {"torus": {"frame": f.json(), "major": big, "minor": r}},
                 lambda u, v: r * (big + r * math.cos(v)),
                 lambda u, v: turn(big + r * math.cos(v), u, r * math.sin(v)),
                 lambda s: TAU * s, lambda t: v0 + length * t, periodic=whole)


def vase(rng: random.Random) -> Round:
    """A surface of revolution of a cubic curve."""
    rho = [rng.uniform(2, 8) for _ in range(4)]
    z = [0.0, rng.uniform(2, 5), rng.uniform(5, 8), rng.uniform(9, 14)]

    def bezier(p: Sequence[float], v: float) -> float:
        w = 1 - v
        return p[0] * w**3 + 3 * p[1] * w * w * v + 3 * p[2] * w * v * v + p[3] * v**3

    def rate(p: Sequence[float], v: float) -> float:
        w = 1 - v
        return 3 * ((p[1] - p[0]) * w * w + 2 * (p[2] - p[1]) * w * v + (p[3] - p[2]) * v * v)

    def describe(f: Frame) -> dict:
        points = [f.at((a, 0, b)) for a, b in zip(rho, z)]
        profile = {"nurbs": {"degree": 3, "knots": [0, 0, 0, 0, 1, 1, 1, 1], "points": points}}
        return {"revolution": {"profile": profile, "axis_origin": list(f.o), "axis": list(f.z)}}

    return Round(describe, lambda u, v: bezier(rho, v) * math.hypot(rate(rho, v), rate(z, v)),
                 lambda u, v: turn(bezier(rho, v), u, bezier(z, v)), lambda s: TAU * s, lambda t: t)


def spline_of(ring: Round, big: float, r: float, v0: float, arcs: int) -> Round:
    """A torus, a band of one, or (big = 0) a sphere, as a rational spline; v has `arcs` quarter circles."""
    half = math.sqrt(0.5)

    def circle(count: int) -> tuple[list[tuple[float, float, float]], list[float]]:
        """Points (cos, sin, weight) of quarter circles, and knots."""
        points = []
        for k in range(2 * count + 1):
            scale = 1.0 if k % 2 == 0 else math.sqrt(2)
            angle = k * math.pi / 4
            points.append((scale * math.cos(angle), scale * math.sin(angle), 1.0 if k % 2 == 0 else half))
        knots = [0.0, 0.0, 0.0]
        for k in range(1, count):
            knots += [k / count] * 2
        return points, knots + [1.0] * 3

    def angle_of(t: float, count: int) -> tuple[float, float]:
        """Angle at a parameter, and its rate."""
        k = math.floor(t * count)
        x = t * count - k
        w = 1 - x
        a, b = w * w + 2 * half * x * w, 2 * half * x * w + x * x
        da, db = -2 * w + 2 * half * (w - x), 2 * half * (w - x) + 2 * x
        # cos ~ a, sin ~ b in the quarter.
        return k * math.pi / 2 + math.atan2(b, a), count * (a * db - b * da) / (a * a + b * b)

    def describe(f: Frame) -> dict:
        us, knots_u = circle(4)
        vs, knots_v = circle(arcs)
        turned_by = (math.cos(v0), math.sin(v0))
        points, weights = [], []
        for cu, su, wu in us:
            for cv, sv, wv in vs:
                c, s = cv * turned_by[0] - sv * turned_by[1], sv * turned_by[0] + cv * turned_by[1]
                rho = big + r * c
                rho = 0.0 if abs(rho) < 1e-12 * r else rho
                points.append(f.at((rho * cu, rho * su, r * s)))
                weights.append(wu * wv)
        return {"nurbs": {"degree": [2, 2], "knots_u": knots_u, "knots_v": knots_v, "points": points,
                          "weights": weights}}

    def density(u: float, v: float) -> float:
        _, du = angle_of(u, 4)
        phi, dv = angle_of(v, arcs)
        return r * (big + r * math.cos(v0 + phi)) * du * dv

    def point(u: float, v: float) -> tuple[float, float, float]:
        theta, _ = angle_of(u, 4)
        phi, _ = angle_of(v, arcs)
        return turn(big + r * math.cos(v0 + phi), theta, r * math.sin(v0 + phi))

    return Round(describe, density, point, lambda s: s, lambda t: t, ring.poles, ring.periodic)


# -- faces


def area(ring: Round, polygon: Polygon) -> float:
    """The area within a closed polygon of parameters: the integral of the density's antiderivative along it."""
    # Gauss's points of three places on each of a few parts.
    gauss = [(-math.sqrt(0.6), 5 / 18), (0.0, 8 / 18), (math.sqrt(0.6), 5 / 18)]
    v_zero = min(v for _, v in polygon)
    total = 0.0
    for (u0, v0), (u1, v1) in zip(polygon, polygon[1:] + polygon[:1]):
        parts = 24 if abs(u1 - u0) > 0 else 1
        for k in range(parts):
            for x, weight in gauss:
                share = (k + 0.5 + 0.5 * x) / parts
                u, v = u0 + (u1 - u0) * share, v0 + (v1 - v0) * share
                inner = sum(w * ring.density(u, v_zero + (v - v_zero) * (j + 0.5 + 0.5 * y) / 8)
                            for j in range(8) for y, w in gauss) / 8 * (v - v_zero)
                total -= inner * (u1 - u0) / parts * weight
    return total


def closed_round(layout: Layout, poles: tuple[bool, bool]) -> Polygon:
    """The outline without holes as one polygon of the chart, cut open somewhere."""
    low = layout.low or [(0.0, 0.0)]
    high = layout.high or [(low[0][0], 1.0)]
    first = [*low, (low[0][0] + 1, low[0][1])]
    second = [*high, (high[0][0] + 1, high[0][1])]
    return first + second[::-1]


def mapped(polygon: Polygon, m: Sequence[Sequence[int]]) -> Polygon:
    return [(m[0][0] * s + m[0][1] * t, m[1][0] * s + m[1][1] * t) for s, t in polygon]


def document(name: str, ring: Round, loops: list[tuple[Polygon, bool]], rng: random.Random) -> dict:
    """A model of one face. `loops`: in parameters, with the face on their left, and whether each is an outer one."""
    frame = turned(rng)
    against = rng.random() < 0.3
    runs = rng.choice([1, 1, 3, 1000])
    with_pcurves = rng.random() < 0.3
    vertices: list[dict] = []
    edges: list[dict] = []
    boundary = []
    order = loops[:]
    rng.shuffle(order)
    for polygon, outer in order:
        # A polygon that winds round repeats its first place one turn on.
        ends = polygon[:-1] if same_place(ring, polygon) else polygon
        n = len(ends)
        start = rng.randrange(n)
        shift = [b - a for a, b in zip(polygon[0], polygon[-1])] if n < len(polygon) else [0.0, 0.0]
        place = lambda k: tuple(ends[k % n][i] + (k // n) * shift[i] for i in range(2))
        stops = list(range(start, start + n, runs)) + [start + n]
        ids = []
        for k in stops[:-1]:
            ids.append(len(vertices))
            vertices.append({"point": frame.at(ring.point(*place(k)))})
        coedges = []
        for i, (a, b) in enumerate(zip(stops, stops[1:])):
            points = [list(place(k)) for k in range(a, b + 1)]
            forward = rng.random() < 0.5
            points = points if forward else points[::-1]
            m = len(points) - 1
            knots = [0.0, *[float(k) for k in range(m + 1)], float(m)]
            flat = {"nurbs": {"degree": 1, "knots": knots, "points": points}}
            p, q = ids[i], ids[(i + 1) % len(ids)]
            edges.append({"curve": {"on_surface": {"surface": 0, "curve": flat}}, "range": [0, m],
                          "start": p if forward else q, "end": q if forward else p})
            pcurves = [{"curve": flat, "range": [0, m]}] if with_pcurves else []
            coedges.append({"edge": len(edges) - 1, "forward": forward, "pcurves": pcurves})
        if against:
            coedges = [{**c, "forward": not c["forward"]} for c in reversed(coedges)]
        boundary.append({"edges": {"outer": outer, "coedges": coedges}})
    face = {"surface": 0, "loops": boundary, "same_sense": not against}
    part = {"name": name, "surfaces": [ring.describe(frame)], "vertices": vertices, "edges": edges, "faces": [face]}
    node = {"name": name, "transform": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]], "part": 0}
    return {"schema": "chordal-model/1", "name": name, "unit": "mm", "parts": [part], "nodes": [node], "roots": [0]}


def same_place(ring: Round, polygon: Polygon) -> bool:
    p, q = ring.point(*polygon[0]), ring.point(*polygon[-1])
    return len(polygon) > 1 and math.dist(p, q) < 1e-9 * (1 + math.dist(p, (0, 0, 0))) and polygon[0] != polygon[-1]


def face(name: str, ring: Round, layout: Layout, rng: random.Random, m: Sequence[Sequence[int]] = ((1, 0), (0, 1)),
         ) -> tuple[float, dict]:
    """The model of a layout on a surface, and its area."""
    place = lambda polygon: [(ring.u(s), ring.v(t)) for s, t in mapped(polygon, m)]
    total = area(ring, place(closed_round(layout, ring.poles)))
    loops: list[tuple[Polygon, bool]] = []
    if layout.low:
        loops.append((place([*layout.low, (layout.low[0][0] + 1, layout.low[0][1])]), True))
    if layout.high:
        loops.append((place([*layout.high, (layout.high[0][0] + 1, layout.high[0][1])][::-1]), False))
    for hole in layout.holes:
        uv = place(hole)
        cut = area(ring, uv)
        total -= abs(cut)
        loops.append((uv if cut < 0 else uv[::-1], False))
    if m[0][0] * m[1][1] - m[0][1] * m[1][0] < 0:
        raise ValueError("a chart keeps its orientation")
    return total, document(name, ring, loops, rng)


def borders(rng: random.Random, ring: Round) -> Layout:
    low = None if ring.poles[0] or ring.periodic else wavy(rng, 0.0, 0.1, 1.0)
    high = None if ring.poles[1] or ring.periodic else wavy(rng, 1.0, 0.1, -1.0)
    return Layout(low, high, holes(rng, ring.periodic))


def plain(make: Callable[[random.Random], Round]) -> Callable[[str, random.Random], tuple[float, dict]]:
    def model(name: str, rng: random.Random) -> tuple[float, dict]:
        ring = make(rng)
        return face(name, ring, borders(rng, ring), rng)

    return model


def slanted(whole: bool) -> Callable[[str, random.Random], tuple[float, dict]]:
    """A torus, or a band of one, whose holes or borders run round both ways at once."""

    def model(name: str, rng: random.Random) -> tuple[float, dict]:
        ring = doughnut(rng, True)
        m = rng.choice([((0, -1), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((1, 0), (-1, 1)), ((2, 1), (1, 1)),
                        ((1, 0), (2, 1))])
        if whole:
            return face(name, ring, Layout(None, None, holes(rng, True)), rng, m)
        at = rng.random()
        squeeze = rng.uniform(0.3, 0.9)
        inside = Layout(wavy(rng, 0.0, 0.1, 1.0), wavy(rng, 1.0, 0.1, -1.0), holes(rng, False))
        move = lambda polygon: [(s, at + squeeze * t) for s, t in polygon]
        layout = Layout(move(inside.low or []), move(inside.high or []), [move(h) for h in inside.holes])
        return face(name, ring, layout, rng, m)

    return model


def spline(poles: int) -> Callable[[random.Random], Round]:
    def make(rng: random.Random) -> Round:
        if poles == 2:
            return spline_of(ball(rng, True, True), 0.0, rng.uniform(2, 10), -math.pi / 2, 2)
        if poles == 1:
            return spline_of(ball(rng, False, True), 0.0, rng.uniform(2, 10), 0.0, 1)
        whole = rng.random() < 0.5
        return spline_of(doughnut(rng, whole), rng.uniform(6, 10), rng.uniform(1, 5), rng.uniform(-3, 3),
                         4 if whole else rng.randrange(1, 4))

    return make


KINDS: dict[str, tuple[str, Callable[[str, random.Random], tuple[float, dict]]]] = {
    "tube": ("a cylinder between two loops", plain(tube)),
    "funnel": ("a cone between two loops", plain(funnel)),
    "cone_tip": ("a cone up to its apex", plain(lambda rng: funnel(rng, True))),
    "ball_band": ("a sphere between two loops", plain(lambda rng: ball(rng, False, False))),
    "ball_cap": ("a sphere up to one pole", plain(lambda rng: ball(rng, False, True))),
    "ball_bowl": ("a sphere down to one pole", plain(lambda rng: ball(rng, True, False))),
    "ball_whole": ("a whole sphere", plain(lambda rng: ball(rng, True, True))),
    "torus_band": ("a torus between two loops", plain(lambda rng: doughnut(rng, False))),
    "torus_whole": ("a whole torus", plain(lambda rng: doughnut(rng, True))),
    "torus_slanted": ("a torus between two loops that wind both ways", slanted(False)),
    "torus_sheared": ("a whole torus, its holes in rows that wind both ways", slanted(True)),
    "vase": ("a surface of revolution between two loops", plain(vase)),
    "spline_ring": ("a torus as a spline, whole or between two loops", plain(spline(0))),
    "spline_cap": ("a sphere as a spline, up to one pole", plain(spline(1))),
    "spline_ball": ("a whole sphere as a spline", plain(spline(2))),
}

# Variants of each kind in the corpus, and single ones that were wrong once.
KEPT = 2
KEPT_AS_WELL = {"torus_sheared": [9]}


def write(folder: Path, numbers: Callable[[str], Sequence[int]]) -> None:
    folder.mkdir(exist_ok=True, parents=True)
    rows = ["file\ttests\tarea\tmade_by"]
    for kind, (tests, make) in KINDS.items():
        for k in numbers(kind):
            name = f"{kind}_{k}"
            right, model = make(name, random.Random(name))
            text = json.dumps(model, separators=(",", ":"))
            (folder / f"{name}.json").write_text(text, encoding="utf-8")
            rows.append(f"{name}.json\t{tests}\t{right:.9g}\tcharts.{kind}")
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--variants", nargs=2, metavar=("OUT", "N"))
    options = parser.parse_args(arguments)
    if options.variants:
        count = int(options.variants[1])
        write(Path(options.variants[0]), lambda kind: range(count))
    else:
        write(FOLDER, lambda kind: [*range(KEPT), *KEPT_AS_WELL.get(kind, [])])


if __name__ == "__main__":
    main()
