"""Faces of which a mesher may take the wrong part: signed and flat surfaces, windows, slivers, folds.

    python corpus/make/region.py                    # writes corpus/region/ and its INDEX.tsv
    python corpus/make/region.py --variants OUT N   # N random variants of each kind, with their right areas

Every model has its right area by a closed form (mm²). All curves are lines and circles, all windows are
rectangles of parameters, so that the areas are exact.
"""

from __future__ import annotations

import argparse
import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from brep_text import Brep
from iges_text import Iges
from part21 import Point, Step, Use, cross, flag, real, refs, unit, write_sheet, write_solid

FOLDER = Path(__file__).resolve().parent.parent / "region"
TAU = 2 * math.pi


@dataclass(frozen=True)
class Frame:
    """A right-handed placement."""

    o: Point = (0, 0, 0)
    x: Point = (1, 0, 0)
    y: Point = (0, 1, 0)
    z: Point = (0, 0, 1)

    def at(self, a: float, b: float, c: float) -> tuple[float, ...]:
        return tuple(o + a * x + b * y + c * z for o, x, y, z in zip(self.o, self.x, self.y, self.z))

    def along(self, a: float, b: float, c: float) -> tuple[float, ...]:
        return tuple(a * x + b * y + c * z for x, y, z in zip(self.x, self.y, self.z))


def turned(rng: random.Random | None) -> Frame:
    """The world frame, or a random one."""
    if rng is None:
        return Frame()
    z = unit([rng.gauss(0, 1) for _ in range(3)])
    x = unit(cross(z, [rng.gauss(0, 1) for _ in range(3)]))
    return Frame([rng.uniform(-50, 50) for _ in range(3)], x, cross(z, x), z)


@dataclass(frozen=True)
class Ring:
    """A surface of revolution by its profile: radius and height over v, straight or circular."""

    kind: str
    values: tuple[float, ...]
    rho: Callable[[float], float]
    height: Callable[[float], float]
    # The centre (radius, height) and radius of the meridian's circle; None for a straight one.
    meridian: tuple[float, float, float] | None
    # The integral of the area per radian of u.
    area: Callable[[float], float]
    negative: bool = False

    def point(self, f: Frame, u: float, v: float) -> tuple[float, ...]:
        r = self.rho(v)
        return f.at(r * math.cos(u), r * math.sin(u), self.height(v))

    def surface(self, s: Step, f: Frame) -> str:
        return s.elementary(self.kind, f.o, f.z, f.x, *self.values)


def cylinder(r: float) -> Ring:
    return Ring("CYLINDRICAL_SURFACE", (r,), lambda v: r, lambda v: v, None, lambda v: abs(r) * v)


def cone(r: float, angle: float) -> Ring:
    t = math.tan(angle)
    slant = 1 / abs(math.cos(angle))
    return Ring(
        "CONICAL_SURFACE",
        (r, angle),
        lambda v: r + v * t,
        lambda v: v,
        None,
        lambda v: slant * (r * v + v * v * t / 2),
    )


def sphere(r: float) -> Ring:
    return Ring(
        "SPHERICAL_SURFACE",
        (r,),
        lambda v: r * math.cos(v),
        lambda v: r * math.sin(v),
        (0, 0, r),
        lambda v: r * r * math.sin(v),
    )


def torus(big: float, r: float) -> Ring:
    """For |big| < r the apple (big > 0) or the lemon (big < 0)."""
    return Ring(
        "TOROIDAL_SURFACE",
        (big, r),
        lambda v: big + r * math.cos(v),
        lambda v: r * math.sin(v),
        (big, 0, r),
        lambda v: r * (big * v + r * math.sin(v)),
    )


def parallel(s: Step, f: Frame, ring: Ring, v: float, u0: float, u1: float) -> Use:
    """The edge of constant v from u0 to u1; a whole circle for a difference of 2π."""
    p, q = ring.point(f, u0, v), ring.point(f, u1 if abs(u1 - u0) < TAU - 1e-9 else u0, v)
    side = 1 if ring.rho(v) > 0 else -1
    curve = s.circle(f.at(0, 0, ring.height(v)), f.z, [side * c for c in f.x], abs(ring.rho(v)))
    return (s.edge(p, q, curve), True) if u1 > u0 else (s.edge(q, p, curve), False)


def meridian(s: Step, f: Frame, ring: Ring, u: float, v0: float, v1: float) -> Use:
    """The edge of constant u from v0 to v1."""
    p, q = ring.point(f, u, v0), ring.point(f, u, v1)
    if ring.meridian is None:
        return s.edge(p, q, s.line(p, q)), True
    a, b, r = ring.meridian
    radial = f.along(math.cos(u), math.sin(u), 0)
    tangent = f.along(math.sin(u), -math.cos(u), 0)
    curve = s.circle(f.at(a * math.cos(u), a * math.sin(u), b), tangent, radial, abs(r))
    up = (v1 > v0) == (r > 0)
    return (s.edge(p, q, curve), True) if up else (s.edge(q, p, curve), False)


def window(s: Step, f: Frame, ring: Ring, u: tuple[float, float], v: tuple[float, float]) -> str:
    """A hole: the rectangle of parameters, on the right for a face with the surface's own sense."""
    return s.bound(
        s.loop(
            [
                meridian(s, f, ring, u[0], v[0], v[1]),
                parallel(s, f, ring, v[1], u[0], u[1]),
                meridian(s, f, ring, u[1], v[1], v[0]),
                parallel(s, f, ring, v[0], u[1], u[0]),
            ]
        )
    )


@dataclass
class Band:
    """A face of a surface of revolution: between two parallels, a pole or nothing, less windows."""

    ring: Ring
    low: float | None
    high: float | None
    span: tuple[float, float]
    windows: list[tuple[tuple[float, float], tuple[float, float]]] = field(default_factory=list)

    def area(self) -> float:
        whole = TAU * (self.ring.area(self.span[1]) - self.ring.area(self.span[0]))
        cut = sum((u[1] - u[0]) * (self.ring.area(v[1]) - self.ring.area(v[0])) for u, v in self.windows)
        return abs(whole - cut)

    def face(self, s: Step, f: Frame, start: float = 0.0) -> str:
        bounds = []
        if self.low is not None:
            bounds.append(
                s.bound(s.loop([parallel(s, f, self.ring, self.low, start, start + TAU)]), outer=True)
            )
        if self.high is not None:
            bounds.append(s.bound(s.loop([parallel(s, f, self.ring, self.high, start + TAU, start)])))
        bounds += [window(s, f, self.ring, u, v) for u, v in self.windows]
        return s.face(bounds, self.ring.surface(s, f))


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


# -- the models

Model = tuple[str, float, Callable[[Path], None]]


def sheet(bands: Callable[[], list[Band]], rng: random.Random | None, start: float = 0.0) -> Model:
    made = bands()

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        write_sheet(s, [band.face(s, f, start) for band in made], path)

    return "", sum(band.area() for band in made), write


def lemon(rng: random.Random | None) -> Model:
    r = rng.uniform(1, 40) if rng else 8.0
    big = -r * (rng.uniform(0.02, 0.9) if rng else 0.25)
    tip = math.acos(-big / r)
    kind = rng.randrange(3) if rng else 0
    a, b = sorted(rng.uniform(-0.95, 0.95) * tip for _ in range(2)) if rng else (-0.3 * tip, 0.8 * tip)
    if kind == 0:
        return sheet(lambda: [Band(torus(big, r), a, b, (a, b))], rng)
    if kind == 1:
        return sheet(lambda: [Band(torus(big, r), a, None, (a, tip))], rng)
    return sheet(lambda: [Band(torus(big, r), None, b, (-tip, b))], rng)


def apple(rng: random.Random | None) -> Model:
    r = rng.uniform(1, 40) if rng else 8.0
    big = r * (rng.uniform(0.02, 0.9) if rng else 0.25)
    tip = math.acos(-big / r)
    a, b = sorted(rng.uniform(-0.95, 0.95) * tip for _ in range(2)) if rng else (-0.3 * tip, 0.8 * tip)
    if rng and rng.randrange(2):
        return sheet(lambda: [Band(torus(big, r), a, None, (a, tip))], rng)
    return sheet(lambda: [Band(torus(big, r), a, b, (a, b))], rng)


def signed(rng: random.Random | None) -> Model:
    r = rng.uniform(1, 40) if rng else 8.0
    kind = rng.randrange(4) if rng else 1
    if kind == 0:
        return sheet(lambda: [Band(cylinder(-r), 0, r, (0, r))], rng)
    if kind == 1:
        return sheet(lambda: [Band(sphere(-r), -0.4, 0.7, (-0.4, 0.7))], rng)
    if kind == 2:
        return sheet(lambda: [Band(cone(-r, 0.3), -r, r, (-r, r))], rng)
    return sheet(lambda: [Band(torus(2 * r, -r), -0.4, 0.7, (-0.4, 0.7))], rng)


def flat_cone(rng: random.Random | None) -> Model:
    """A cone a little off a plane, given as files give it: by an angle near 90 degrees."""
    off = 10 ** rng.uniform(-12, -3) if rng else math.pi / 2 - 1.570796251297
    angle = math.pi / 2 - off
    t = math.tan(angle)
    r0, r1 = (rng.uniform(2, 20), rng.uniform(25, 60)) if rng else (5.0, 30.0)
    if rng and rng.randrange(2):
        angle, t = -angle, -t
    ring = cone(r0, angle)
    end = (r1 - r0) / t
    a, b = min(0, end), max(0, end)
    around = rng.randrange(0, 6) if rng else 3
    windows = [
        ((TAU * k / around, TAU * (k + 0.4) / around), (a + 0.3 * (b - a), a + 0.6 * (b - a)))
        for k in range(around)
    ]
    return sheet(lambda: [Band(ring, a, b, (a, b), windows)], rng)


def steep_cone(rng: random.Random | None) -> Model:
    """A cone a little off a cylinder."""
    angle = 10 ** rng.uniform(-14, -3) if rng else 1e-9
    r = rng.uniform(2, 20) if rng else 5.0
    return sheet(lambda: [Band(cone(r, angle), 0, 3 * r, (0, 3 * r))], rng)


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


def sliver(rng: random.Random | None) -> Model:
    """A box of which one vertical edge is given twice, with a face between the two that has no area."""
    a, b, c = [rng.uniform(2, 30) for _ in range(3)] if rng else (20.0, 12.0, 8.0)
    off = (10 ** rng.uniform(-9, -5) * c) if rng else 2e-6
    loose = rng.randrange(2) if rng else 0

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=1e-5)
        f = turned(rng)
        at = f.at
        low = [at(0, 0, 0), at(a, 0, 0), at(a, b, 0), at(0, b, 0)]
        high = [at(0, 0, c), at(a, 0, c), at(a, b, c), at(0, b, c)]
        p, q = low[1], high[1]
        # The same two vertices; the second curve leaves them by a little.
        if loose:
            second = s.edge(p, q, s.line(at(a + off, 0, 0), at(a + off, 0, c)))
        else:
            middle = at(a + off, -off, c / 2)
            second = s.edge(p, q, s.spline(2, [p, middle, q], [0, 1], [3, 3]))
        first, _ = s.segment(p, q)
        side = [s.flat([low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]]) for i in (0, 2, 3)]
        right = s.loop(
            [
                s.segment(low[1], low[2]),
                s.segment(low[2], high[2]),
                s.segment(high[2], high[1]),
                (second, False),
            ]
        )
        side.append(s.face([s.bound(right, outer=True)], s.plane(low[1], f.x, f.y)))
        normal = f.along(math.sqrt(0.5), -math.sqrt(0.5), 0)
        thin = s.loop([(first, False), (second, True)])
        side.append(s.face([s.bound(thin, outer=True)], s.plane(p, normal, f.z)))
        write_solid(s, [*side, s.flat(low[::-1]), s.flat(high)], path)

    return "", 2 * (a * b + b * c + c * a), write


def folded_edge(rng: random.Random | None) -> Model:
    """A plate with a slit of no width: one closed edge, there and back, and a cylinder's face in it."""
    a, b = [rng.uniform(5, 30) for _ in range(2)] if rng else (20.0, 12.0)
    r = min(a, b) * 0.2

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        p, q = f.at(a / 2, b / 2, 0), f.at(a / 2 + r, b / 2, 0)
        there_and_back = s.edge(p, p, s.spline(1, [p, q, p], [0, 0.5, 1], [2, 1, 2]))
        corners = [f.at(0, 0, 0), f.at(a, 0, 0), f.at(a, b, 0), f.at(0, b, 0)]
        plate = s.face(
            [s.bound(s.polygon(corners), outer=True), s.bound(s.loop([(there_and_back, False)]))],
            s.plane(f.o, f.z, f.x),
        )
        tube = s.elementary("CYLINDRICAL_SURFACE", f.at(a / 2, b / 2, -r), f.x, f.z, r)
        inside = s.face([s.bound(s.loop([(there_and_back, True)]), outer=True)], tube)
        write_sheet(s, [plate, inside], path)

    return "", a * b, write


def no_length(rng: random.Random | None) -> Model:
    """A plate with an edge of no length and one that runs back over its neighbour."""
    a, b = [rng.uniform(5, 30) for _ in range(2)] if rng else (20.0, 12.0)

    def write(path: Path) -> None:
        s = Step(path.stem, uncertainty=1e-5)
        f = turned(rng)
        o, x, xy, y = f.at(0, 0, 0), f.at(a, 0, 0), f.at(a, b, 0), f.at(0, b, 0)
        tip = f.at(a, 1.5 * b, 0)
        again = s.add(f"VERTEX_POINT('',{s.point(tip)})")
        nothing = s.add(
            f"EDGE_CURVE('',{s.vertex(tip)},{again},{s.line(tip, f.at(a - 2e-6, 1.5 * b, 0))},.T.)"
        )
        back = s.add(f"EDGE_CURVE('',{again},{s.vertex(xy)},{s.line(tip, xy)},.T.)")
        uses = [
            s.segment(o, x),
            s.segment(x, tip),
            (nothing, True),
            (back, True),
            s.segment(xy, y),
            s.segment(y, o),
        ]
        write_sheet(s, [s.face([s.bound(s.loop(uses), outer=True)], s.plane(f.o, f.z, f.x))], path)

    return "", a * b, write


def huge(rng: random.Random | None) -> Model:
    """A small rectangle of parameters of a surface with a huge radius, near the origin."""
    r = 10 ** rng.uniform(3, 10) if rng else 1e10
    width = 20 / r
    kind = rng.randrange(3) if rng else 1
    ring, v = [(cylinder(r), (0.0, 10.0)), (sphere(r), (0.0, width / 2)), (torus(r, 5.0), (0.0, 1.5))][kind]
    u = (0.3, 0.3 + width)
    area = width * (ring.area(v[1]) - ring.area(v[0]))

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        far = ring.point(f, 0.3, v[0])
        f = Frame([o - p for o, p in zip(f.o, far)], f.x, f.y, f.z)
        sides = [
            parallel(s, f, ring, v[0], u[0], u[1]),
            meridian(s, f, ring, u[1], v[0], v[1]),
            parallel(s, f, ring, v[1], u[1], u[0]),
            meridian(s, f, ring, u[0], v[1], v[0]),
        ]
        write_sheet(s, [s.face([s.bound(s.loop(sides), outer=True)], ring.surface(s, f))], path)

    return "", area, write


def scattered(rng: random.Random | None) -> Model:
    """Half a cylinder as a CURVE_BOUNDED_SURFACE; its four pieces come in any order and direction."""
    r, h = (rng.uniform(2, 20), rng.uniform(2, 20)) if rng else (5.0, 20.0)
    order = rng.sample(range(4), 4) if rng else [2, 0, 3, 1]
    backwards = [rng.random() < 0.5 for _ in range(4)] if rng else [True, False, False, True]

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        corners = [f.at(r, 0, 0), f.at(-r, 0, 0), f.at(-r, 0, h), f.at(r, 0, h)]
        arcs = [s.circle(f.at(0, 0, z), f.z, f.x, r) for z in (0, h)]
        curves = [arcs[0], s.line(corners[1], corners[2]), arcs[1], s.line(corners[0], corners[3])]
        # From where to where each curve runs in its own direction.
        ends = [(0, 1), (1, 2), (3, 2), (0, 3)]
        segments = []
        for k in order:
            a, b = (s.point(corners[i]) for i in ends[k])
            piece = s.add(f"TRIMMED_CURVE('',{curves[k]},({a}),({b}),.T.,.CARTESIAN.)")
            sense = flag(not backwards[k])
            segments.append(s.add(f"COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,{sense},{piece})"))
        surface = s.elementary("CYLINDRICAL_SURFACE", f.o, f.z, f.x, r)
        border = s.add(f"OUTER_BOUNDARY_CURVE('',{refs(segments)},.F.)")
        bounded = s.add(f"CURVE_BOUNDED_SURFACE('',{surface},({border}),.F.)")
        items = [s.axes(), s.add(f"GEOMETRIC_SET('',({bounded}))")]
        s.part(items, "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION")
        s.write(path)

    return "", math.pi * r * h, write


def no_radius(rng: random.Random | None) -> Model:
    """A disc, and beside it a cylinder without a radius between two circles without one."""
    r = rng.uniform(2, 20) if rng else 8.0

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        disc = s.disc(s.ring(f.o, f.z, f.x, r), True, f.o, f.z, f.x)
        rings = []
        for h in (0.0, r):
            p = f.at(2 * r, 0, h)
            rings.append(s.edge(p, p, s.circle(p, f.z, f.x, 0.0)))
        bounds = [s.bound(s.loop([(rings[0], True)]), outer=True), s.bound(s.loop([(rings[1], False)]))]
        needle = s.face(bounds, s.elementary("CYLINDRICAL_SURFACE", f.at(2 * r, 0, 0), f.z, f.x, 0.0))
        write_sheet(s, [disc, needle], path)

    return "", math.pi * r * r, write


def fillet(rng: random.Random | None) -> Model:
    """An eighth of a thin tube: at a tolerance of about its radius, chords of its rims fold facets."""
    big, r = (rng.uniform(10, 40), 1.5) if rng else (31.25, 1.5)
    return sheet(lambda: [Band(torus(big, r), -math.pi / 2, -math.pi / 4, (-math.pi / 2, -math.pi / 4))], rng)


def horn_wedge(rng: random.Random | None) -> Model:
    """A wedge of a torus whose radii differ by rounding alone, between two circles through its pole."""
    r = rng.uniform(1, 40) if rng else 1.0
    u0, u1 = (0.3, 0.3 + (rng.uniform(0.2, 6.0) if rng else math.pi / 2))
    ring = torus(r, r)

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)

        def half(u: float, near: bool) -> str:
            """From the pole to the equator, or from there to the pole."""
            pole, far = f.o, ring.point(f, u, 0)
            tangent = f.along(math.sin(u), -math.cos(u), 0)
            curve = s.circle(f.at(r * math.cos(u), r * math.sin(u), 0), tangent, f.along(math.cos(u), math.sin(u), 0), r)
            return s.edge(pole, far, curve) if near else s.edge(far, pole, curve)

        uses = [(half(u1, True), True), (half(u1, False), True), (half(u0, False), False), (half(u0, True), False)]
        spindle = s.elementary("TOROIDAL_SURFACE", f.o, f.z, f.x, r, r * (1 + 3e-16))
        write_sheet(s, [s.face([s.bound(s.loop(uses), outer=True)], spindle)], path)

    return "", (u1 - u0) * TAU * r * r, write


def offset_revolved(rng: random.Random | None) -> Model:
    """A band of a lemon torus, as the offset of the surface that turns a smaller circle."""
    r = rng.uniform(10, 40) if rng else 51.0
    big = -r * (rng.uniform(0.05, 0.4) if rng else 0.4)
    d = r * (rng.uniform(0.01, 0.2) if rng else 0.1)
    ring = torus(big, r)
    a, b = -0.4, 0.6

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        profile = s.circle(f.at(big, 0, 0), [-c for c in f.y], f.x, r - d)
        swept = s.add(f"SURFACE_OF_REVOLUTION('',{profile},{s.axis(f.o, f.z)})")
        offset = s.add(f"OFFSET_SURFACE('',{swept},{real(d)},.F.)")
        bounds = [
            s.bound(s.loop([parallel(s, f, ring, a, 0, TAU)]), outer=True),
            s.bound(s.loop([parallel(s, f, ring, b, TAU, 0)])),
        ]
        write_sheet(s, [s.face(bounds, offset)], path)

    return "", TAU * (ring.area(b) - ring.area(a)), write


def offset_extruded(rng: random.Random | None) -> Model:
    """A tube, as the offset of an extruded circle."""
    r, h = (rng.uniform(2, 20), rng.uniform(2, 20)) if rng else (11.0, 20.0)
    ring = cylinder(r)

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        along = s.add(f"VECTOR('',{s.direction(f.z)},1.)")
        swept = s.add(f"SURFACE_OF_LINEAR_EXTRUSION('',{s.circle(f.o, f.z, f.x, 0.9 * r)},{along})")
        offset = s.add(f"OFFSET_SURFACE('',{swept},{real(0.1 * r)},.F.)")
        bounds = [
            s.bound(s.loop([parallel(s, f, ring, 0, 0, TAU)]), outer=True),
            s.bound(s.loop([parallel(s, f, ring, h, TAU, 0)])),
        ]
        write_sheet(s, [s.face(bounds, offset)], path)

    return "", TAU * r * h, write


def band_iges(path: Path, kind: int, sizes: tuple[float, ...], ring: Ring, span: tuple[float, float]) -> None:
    """A band of a torus (198) or a sphere (196) between two circles without curves of parameters."""
    g = Iges()
    center, axis = g.add(116, 0.0, 0.0, 0.0, 0), g.add(123, 0.0, 0.0, 1.0)
    surface = g.add(kind, center, axis, *sizes) if kind == 198 else g.add(kind, center, *sizes)
    circles = [g.circle((0.0, 0.0), abs(ring.rho(v)), ring.height(v)) for v in span]
    g.trimmed(surface, *[g.boundary(surface, 0, circle, 2) for circle in circles])
    path.write_text(g.text(), encoding="ascii")


def band_brep(path: Path, kind: int, sizes: tuple[float, ...], ring: Ring, span: tuple[float, float]) -> None:
    """The same as a face of a BREP file, of kind 5 (torus) or 4 (sphere)."""
    b = Brep()
    axes = ((0, 0, 1), (1, 0, 0), (0, 1, 0))
    surface = b.surface(kind, (0, 0, 0), *axes, *sizes)
    wires = []
    for v, sign in zip(span, "+-"):
        radius, height = abs(ring.rho(v)), ring.height(v)
        circle = b.curve(2, (0, 0, height), *axes, radius)
        vertex = b.vertex((radius, 0, height))
        wires.append(b.wire((sign, b.edge((vertex, vertex), circle, (0, TAU)), 0)))
    face = b.face(surface, *wires)
    path.write_text(b.text(b.shell(("+", face, 0), closed=False)), encoding="ascii")


# Other formats: (file, what it tests, kind of the surface, sizes, the surface, the range of v).
OTHERS = [
    ("lemon_negative.igs", "a band of a lemon torus in IGES", 198, (-2.0, 8.0), torus(-2, 8), (-0.4, 0.9)),
    ("sphere_negative.igs", "a sphere with a negative radius in IGES", 196, (-8.0,), sphere(-8), (-0.4, 0.9)),
    ("lemon_negative.brep", "a band of a lemon torus in BREP", 5, (-2.0, 8.0), torus(-2, 8), (-0.4, 0.9)),
    ("sphere_negative.brep", "a sphere with a negative radius in BREP", 4, (-8.0,), sphere(-8), (-0.4, 0.9)),
]


KINDS: dict[str, tuple[str, Callable[[random.Random | None], Model]]] = {
    "lemon_negative": ("a band of a lemon torus, its major radius negative", lemon),
    "apple_band": ("a band of an apple torus", apple),
    "sphere_negative": ("a sphere with a negative radius", signed),
    "cone_nearly_flat": ("a cone 7.5e-8 off a plane, with windows", flat_cone),
    "cone_nearly_straight": ("a cone 1e-9 off a cylinder", steep_cone),
    "tube_perforated": ("a tube with windows all round: no straight line for a seam", tube),
    "funnel_perforated": ("a cone with windows all round", funnel),
    "dome_perforated": ("a cap round a pole with windows all round", dome),
    "sphere_perforated": ("a whole sphere with windows all round", strainer),
    "torus_band_perforated": ("a band of a torus with windows all round", ring_band),
    "torus_perforated": ("a whole torus with windows all round one way", ring_whole),
    "torus_blocked": ("a whole torus with windows in the way of every straight cut", ring_blocked),
    "sliver_on_edge": ("a box with a face of no area between two edges that coincide", sliver),
    "edge_folded": ("a closed edge that returns on its own way", folded_edge),
    "sphere_huge": ("a small patch of a sphere with a radius of 1e10 mm", huge),
    "curve_bounded_scattered": ("CURVE_BOUNDED_SURFACE with pieces in any order", scattered),
    "cylinder_without_radius": ("a cylinder with a radius of zero", no_radius),
    "fillet_thin": ("an eighth of a thin tube, for coarse tolerances", fillet),
    "torus_horn_rounded": ("a wedge of a torus whose radii differ by rounding", horn_wedge),
    "offset_revolved": ("the offset of a revolved circle that passes the axis", offset_revolved),
    "offset_extruded": ("the offset of an extruded circle", offset_extruded),
    "edge_without_length": ("an edge of no length and one that runs back over its neighbour", no_length),
}


def write_all(folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    rows = ["file\ttests\tarea\tmade_by"]
    for name, (tests, make) in KINDS.items():
        _, area, write = make(None)
        write(folder / f"{name}.step")
        rows.append(f"{name}.step\t{tests}\t{area:.9g}\tregion.{make.__name__}")
    for file, tests, kind, sizes, ring, span in OTHERS:
        band = band_iges if file.endswith(".igs") else band_brep
        band(folder / file, kind, sizes, ring, span)
        area = Band(ring, *span, span).area()
        rows.append(f"{file}\t{tests}\t{area:.9g}\tregion.{band.__name__}")
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")


def write_variants(folder: Path, count: int) -> None:
    folder.mkdir(exist_ok=True, parents=True)
    rows = ["file\ttests\tarea\tmade_by"]
    for name, (tests, make) in KINDS.items():
        for k in range(count):
            _, area, write = make(random.Random(f"{name}{k}"))
            write(folder / f"{name}_{k}.step")
            rows.append(f"{name}_{k}.step\t{tests}\t{area:.9g}\tregion.{make.__name__}")
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--variants", nargs=2, metavar=("OUT", "N"))
    options = parser.parse_args(arguments)
    if options.variants:
        write_variants(Path(options.variants[0]), int(options.variants[1]))
    else:
        write_all(FOLDER)


if __name__ == "__main__":
    main()
