"""Faces and loops without area, on every kind of surface: slivers, edges of no length, folded edges.

    python corpus/make/slivers.py                    # writes corpus/slivers/ and its INDEX.tsv
    python corpus/make/slivers.py --variants OUT N   # N random variants of each kind, with their right areas

A *patch* is a rectangle of parameters of a plane, a surface of revolution or the same as a spline. Its sides
are lines and circles, so its area has a closed form. Each kind adds something that has no area: a face
between two edges that coincide within the file's accuracy, an edge of no length, a loop of two points.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from part21 import Step, Use, write_sheet, write_solid
from rings import TAU, Frame, Model, Ring, cone, cylinder, meridian, parallel, sphere, torus, turned
from spline_patches import arc, conic, rational_patch
from variants import main

FOLDER = Path(__file__).resolve().parent.parent / "slivers"


def disc() -> Ring:
    """A plane in polar parameters."""
    return Ring("PLANE", (), lambda v: v, lambda v: 0.0, None, lambda v: v * v / 2)


@dataclass
class Patch:
    """A rectangle of parameters of a ring."""

    ring: Ring
    u: tuple[float, float]
    v: tuple[float, float]
    spline: bool
    # The length of its shorter side, and the file's accuracy.
    size: float
    accuracy: float

    def area(self) -> float:
        return (self.u[1] - self.u[0]) * (self.ring.area(self.v[1]) - self.ring.area(self.v[0]))

    def step(self, name: str) -> Step:
        return Step(name, uncertainty=self.accuracy)

    def surface(self, s: Step, f: Frame) -> str:
        if self.spline:
            return rational_patch(s, f, self.ring, self.u, self.v)
        if self.ring.kind == "PLANE":
            # Angle and radius run against the plane's own sense.
            return s.plane(f.o, [-c for c in f.z], f.x)
        return self.ring.surface(s, f)

    def side(self, s: Step, f: Frame, k: int) -> Use:
        """Side k of the border, which runs counter-clockwise in parameters."""
        (u0, u1), (v0, v1) = self.u, self.v
        if k == 0:
            return parallel(s, f, self.ring, v0, u0, u1)
        if k == 1:
            return meridian(s, f, self.ring, u1, v0, v1)
        if k == 2:
            return parallel(s, f, self.ring, v1, u1, u0)
        return meridian(s, f, self.ring, u0, v1, v0)

    def ends(self, k: int) -> tuple[tuple[float, float], tuple[float, float]]:
        (u0, u1), (v0, v1) = self.u, self.v
        corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]
        return corners[k], corners[(k + 1) % 4]

    def point(self, f: Frame, place: Sequence[float]) -> tuple[float, ...]:
        return self.ring.point(f, place[0], place[1])

    def face(self, s: Step, f: Frame, loop: Sequence[Use], *inner: Sequence[Use]) -> str:
        bounds = [s.bound(s.loop(loop), outer=True), *[s.bound(s.loop(uses)) for uses in inner]]
        return s.face(bounds, self.surface(s, f))


def patch(rng: random.Random) -> Patch:
    scale = 10 ** rng.uniform(-1.5, 3)
    kind = rng.randrange(5)
    width = rng.uniform(0.2, 1.4)
    u0 = rng.uniform(-3, 3)
    if kind == 0:
        ring, v = disc(), (rng.uniform(0.3, 1) * scale, rng.uniform(1.2, 3) * scale)
    elif kind == 1:
        ring, v = cylinder(scale), (0.0, rng.uniform(0.3, 3) * scale)
    elif kind == 2:
        ring, v = cone(scale, rng.uniform(-0.5, 0.9)), (0.0, rng.uniform(0.3, 1.5) * scale)
    elif kind == 3:
        ring, v = sphere(scale), (rng.uniform(-1.2, -0.2), rng.uniform(0, 1.2))
    else:
        v0 = rng.uniform(-3, 3)
        ring, v = torus(scale * rng.uniform(1.5, 4), scale), (v0, v0 + rng.uniform(0.3, 1.4))
    along = (v[1] - v[0]) * (1 if kind < 3 else scale)
    across = width * min(abs(ring.rho(v[0])), abs(ring.rho(v[1])))
    size = min(along, across)
    return Patch(ring, (u0, u0 + width), v, rng.random() < 0.4, size, size * 10 ** rng.uniform(-6.5, -4))


def again(s: Step, f: Frame, p: Patch, k: int, off: float, rng: random.Random) -> Use:
    """A second edge between the ends of side k, away from it by `off` at most, as a conic spline."""
    a, b = p.ends(k)
    points, weights = arc(p.ring, f, a, b)
    push = [rng.gauss(0, 1) for _ in range(3)]
    length = math.hypot(*push)
    middle = [c + off * d / length for c, d in zip(points[1], push)]
    edge = s.edge(points[0], points[2], conic(s, [points[0], middle, points[2]], weights))
    return (edge, True)


def reverse(use: Use) -> Use:
    return use[0], not use[1]


def outline(s: Step, f: Frame, p: Patch) -> list[Use]:
    return [p.side(s, f, k) for k in range(4)]


# -- the kinds


def between(rng: random.Random) -> Model:
    """A patch, and beside it a face between its side and an edge that coincides with it."""
    p = patch(rng)
    k, off = rng.randrange(4), p.accuracy * 10 ** rng.uniform(-3, -0.1)
    exact, first, backwards = rng.random() < 0.3, rng.random() < 0.5, rng.random() < 0.5

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        loop = outline(s, f, p)
        second = again(s, f, p, k, 0.0 if exact else off, rng)
        thin = [reverse(loop[k]), second]
        faces = [p.face(s, f, loop), p.face(s, f, [reverse(e) for e in reversed(thin)] if backwards else thin)]
        write_sheet(s, faces[::-1] if first else faces, path)

    return "", p.area(), write


def alone(rng: random.Random) -> Model:
    """Two patches side by side, the sliver between them: neither has the other's edge."""
    p = patch(rng)
    k, off = rng.randrange(4), p.accuracy * 10 ** rng.uniform(-3, -0.1)
    share = rng.uniform(0.2, 0.8)

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        cut = p.v[0] + share * (p.v[1] - p.v[0]) if k % 2 == 0 else p.u[0] + share * (p.u[1] - p.u[0])
        low = Patch(p.ring, p.u, (p.v[0], cut), p.spline, p.size, p.accuracy)
        high = Patch(p.ring, p.u, (cut, p.v[1]), p.spline, p.size, p.accuracy)
        side, other = 2, 0
        if k % 2:
            low = Patch(p.ring, (p.u[0], cut), p.v, p.spline, p.size, p.accuracy)
            high = Patch(p.ring, (cut, p.u[1]), p.v, p.spline, p.size, p.accuracy)
            side, other = 1, 3
        a, b = outline(s, f, low), outline(s, f, high)
        b[other] = again(s, f, high, other, off, rng)
        faces = [low.face(s, f, a), p.face(s, f, [reverse(a[side]), reverse(b[other])]), high.face(s, f, b)]
        rng.shuffle(faces)
        write_sheet(s, faces, path)

    return "", p.area(), write


def no_length(rng: random.Random) -> Model:
    """A patch with edges of no length at some of its corners."""
    p = patch(rng)
    how = [rng.choice([None, "line", "apart", "spline", "circle"]) for _ in range(4)]

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        loop: list[Use] = []
        for k, side in enumerate(outline(s, f, p)):
            loop.append(side)
            end = p.point(f, p.ends(k)[1])
            beside = [c + 0.3 * p.accuracy * d for c, d in zip(end, f.x)]
            if how[k] == "line":
                loop.append((s.edge(end, end, s.line(end, [c + d for c, d in zip(end, f.y)])), rng.random() < 0.5))
            elif how[k] == "spline":
                loop.append((s.edge(end, end, s.spline(2, [end, end, end], [0, 1], [3, 3])), rng.random() < 0.5))
            elif how[k] == "circle":
                center = [c - 0.2 * p.accuracy * d for c, d in zip(end, f.x)]
                loop.append((s.edge(end, end, s.circle(center, f.z, f.x, 0.2 * p.accuracy)), rng.random() < 0.5))
            elif how[k] == "apart":
                loop.append((s.edge(end, beside, s.line(end, beside)), True))
                loop.append((s.edge(beside, end, s.line(beside, end)), True))
        write_sheet(s, [p.face(s, f, loop)], path)

    return "", p.area(), write


def vertices_apart(rng: random.Random) -> Model:
    """A patch whose sides end near each other, within the accuracy: each corner is two vertices."""
    p = patch(rng)
    bridged = rng.random() < 0.7

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        loop: list[Use] = []
        moved: list[list[float]] = []
        for k in range(4):
            end = p.point(f, p.ends(k)[1])
            push = [rng.uniform(-0.3, 0.3) * p.accuracy for _ in range(3)]
            moved.append([c + d for c, d in zip(end, push)])
        for k in range(4):
            a, b = p.ends(k)
            points, weights = arc(p.ring, f, a, b)
            start = moved[k - 1]
            loop.append((s.edge(start, points[2], conic(s, points, weights)), True))
            if bridged:
                loop.append((s.edge(points[2], moved[k], s.line(points[2], moved[k])), True))
        write_sheet(s, [p.face(s, f, loop)], path)

    return "", p.area(), write


def inner(p: Patch, rng: random.Random) -> tuple[tuple[float, float], tuple[float, float]]:
    """The ends of a line of constant u or v inside a patch."""
    place = lambda t: (p.u[0] + t[0] * (p.u[1] - p.u[0]), p.v[0] + t[1] * (p.v[1] - p.v[0]))
    x, (a, b) = rng.uniform(0.2, 0.8), sorted(rng.uniform(0.15, 0.85) for _ in range(2))
    b = max(b, a + 0.05)
    return (place((x, a)), place((x, b))) if rng.random() < 0.5 else (place((a, x)), place((b, x)))


def slit(rng: random.Random) -> Model:
    """A patch with a hole of two points: there by one edge, back by another or the same one."""
    p = patch(rng)
    a, b = inner(p, rng)
    off = p.accuracy * rng.choice([0.0, 10 ** rng.uniform(-3, -0.1)])
    same = rng.random() < 0.3

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        points, weights = arc(p.ring, f, a, b)
        there = s.edge(points[0], points[2], conic(s, points, weights))
        middle = [c + off * d for c, d in zip(points[1], f.x)]
        back = there if same else s.edge(points[0], points[2], conic(s, [points[0], middle, points[2]], weights))
        write_sheet(s, [p.face(s, f, outline(s, f, p), [(there, True), (back, False)])], path)

    return "", p.area(), write


def folded(rng: random.Random) -> Model:
    """A patch with a hole of one closed edge that returns on its own way, and a face in that hole."""
    p = patch(rng)
    a, b = inner(p, rng)
    filled = rng.random() < 0.5

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        points, weights = arc(p.ring, f, a, b)
        there_and_back = conic(s, [*points, points[1], points[0]], [*weights, weights[1], weights[0]])
        edge = s.edge(points[0], points[0], there_and_back)
        faces = [p.face(s, f, outline(s, f, p), [(edge, False)])]
        if filled:
            faces.append(p.face(s, f, [(edge, True)]))
        write_sheet(s, faces, path)

    return "", p.area(), write


def spike(rng: random.Random) -> Model:
    """A patch whose border leaves one corner along a side beyond it, or inwards, and returns by the same edge."""
    p = patch(rng)
    k = rng.randrange(4)
    outwards = rng.random() < 0.5
    length = rng.uniform(0.02, 0.3)
    twice = rng.random() < 0.5

    def write(path: Path) -> None:
        s, f = p.step(path.stem), turned(rng)
        loop = outline(s, f, p)
        a, b = p.ends(k)
        if not outwards:
            a, b = p.ends((k + 1) % 4)[1], b
            inside = [q + 0.5 * (r - q) for q, r in zip(p.ends(k)[0], b)]
            # From the middle of side k, straight across.
            a = inside
            far = p.ends((k + 1) % 4)
            tip = [q + length * (r - o) for q, o, r in zip(inside, far[0], far[1])]
            first = p.ends(k)[0]
            halves = [_edge(s, f, p, first, inside), _edge(s, f, p, inside, b)]
            out = _edge(s, f, p, inside, tip)
            back = _edge(s, f, p, tip, inside) if twice else reverse(out)
            loop[k:k + 1] = [halves[0], out, back, halves[1]]
        else:
            tip = [q + length * (r - q) for q, r in zip(b, [2 * y - x for x, y in zip(a, b)])]
            out = _edge(s, f, p, b, tip)
            back = _edge(s, f, p, tip, b) if twice else reverse(out)
            loop[k + 1:k + 1] = [out, back]
        write_sheet(s, [p.face(s, f, loop)], path)

    return "", p.area(), write


def _edge(s: Step, f: Frame, p: Patch, a: Sequence[float], b: Sequence[float]) -> Use:
    points, weights = arc(p.ring, f, a, b)
    return s.edge(points[0], points[2], conic(s, points, weights)), True


def thin(rng: random.Random) -> Model:
    """A patch, and beside it one that is thin but wider than the accuracy, down to a millionth of its length."""
    p = patch(rng)
    share = 10 ** rng.uniform(-5, -1)
    across = rng.random() < 0.5
    single = rng.random() < 0.4
    if across:
        cut = p.u[0] + share * (p.u[1] - p.u[0])
        strip = Patch(p.ring, (p.u[0], cut), p.v, p.spline, p.size, p.accuracy)
        rest = Patch(p.ring, (cut, p.u[1]), p.v, p.spline, p.size, p.accuracy)
    else:
        cut = p.v[0] + share * (p.v[1] - p.v[0])
        strip = Patch(p.ring, p.u, (p.v[0], cut), p.spline, p.size, p.accuracy)
        rest = Patch(p.ring, p.u, (cut, p.v[1]), p.spline, p.size, p.accuracy)
    accuracy = min(p.accuracy, p.size * share / 30)

    def write(path: Path) -> None:
        s, f = Step(path.stem, uncertainty=accuracy), turned(rng)
        a, b = outline(s, f, strip), outline(s, f, rest)
        if across:
            b[3] = reverse(a[1])
        else:
            b[0] = reverse(a[2])
        faces = [strip.face(s, f, a)] + ([] if single else [rest.face(s, f, b)])
        write_sheet(s, faces, path)

    return "", strip.area() + (0 if single else rest.area()), write


def sector(rng: random.Random) -> Model:
    """A solid: a sector of a tube, with faces of no area between some of its faces."""
    r0 = 10 ** rng.uniform(-1, 2.5)
    r1, h, width = r0 * rng.uniform(1.2, 3), r0 * rng.uniform(0.3, 3), rng.uniform(0.3, 2.8)
    size = min(r1 - r0, h, r0 * width)
    accuracy = size * 10 ** rng.uniform(-6, -4)
    chosen = {k for k in range(12) if rng.random() < 0.25}
    inside, outside = cylinder(r0), cylinder(r1)
    flat = width * (r1 * r1 - r0 * r0) / 2
    area = 2 * flat + width * h * (r0 + r1) + 2 * h * (r1 - r0)

    def write(path: Path) -> None:
        s, f = Step(path.stem, uncertainty=accuracy), turned(rng)
        slivers: list[str] = []

        def edge(k: int, ring: Ring, a: Sequence[float], b: Sequence[float], surface: Callable[[], str]) -> tuple:
            """The edge as the one face has it and as the other has it."""
            points, weights = arc(ring, f, a, b)
            one = s.edge(points[0], points[2], conic(s, points, weights))
            if k not in chosen:
                return one, one
            push = [rng.gauss(0, 1) for _ in range(3)]
            length = math.hypot(*push)
            middle = [c + rng.uniform(0, 0.9) * accuracy * d / length for c, d in zip(points[1], push)]
            two = s.edge(points[0], points[2], conic(s, [points[0], middle, points[2]], weights))
            slivers.append(s.face([s.bound(s.loop([(one, False), (two, True)]), outer=True)], surface()))
            return one, two

        def level(z: float) -> Ring:
            return Ring("PLANE", (), lambda v: v, lambda v: z, None, lambda v: v * v / 2)

        surfaces = {
            "in": lambda: inside.surface(s, f),
            "out": lambda: outside.surface(s, f),
            "low": lambda: s.plane(f.at(0, 0, 0), f.z, f.x),
            "high": lambda: s.plane(f.at(0, 0, h), f.z, f.x),
            "first": lambda: s.plane(f.o, f.along(0, -1, 0), f.x),
            "last": lambda: s.plane(f.o, f.along(-math.sin(width), math.cos(width), 0), f.z),
        }
        uprights = {}
        for k, (ring, name, u) in enumerate([(inside, "in", 0.0), (inside, "in", width), (outside, "out", 0.0),
                                             (outside, "out", width)]):
            uprights[name, u > 0] = edge(k, ring, (u, 0.0), (u, h), surfaces[name])
        arcs = {}
        for k, (ring, name, z) in enumerate([(inside, "in", 0.0), (inside, "in", h), (outside, "out", 0.0),
                                             (outside, "out", h)], 4):
            arcs[name, z > 0] = edge(k, ring, (0.0, z), (width, z), surfaces["high" if z > 0 else "low"])
        spokes = {}
        for k, (u, z) in enumerate([(0.0, 0.0), (0.0, h), (width, 0.0), (width, h)], 8):
            spokes[u > 0, z > 0] = edge(k, level(z), (u, r0), (u, r1), surfaces["first" if u == 0 else "last"])
        # Each sliver lies between the first edge (F) and the second (T); so each face has one of them.
        F, T = 0, 1
        loops = {
            # The surface's own sense points outwards for the outer one only.
            "out": [(arcs["out", False][F], True), (uprights["out", True][F], True), (arcs["out", True][T], False),
                    (uprights["out", False][T], False)],
            "in": [(uprights["in", False][F], True), (arcs["in", True][F], True), (uprights["in", True][T], False),
                   (arcs["in", False][T], False)],
            "low": [(arcs["in", False][F], True), (spokes[True, False][F], True), (arcs["out", False][T], False),
                    (spokes[False, False][T], False)],
            "high": [(spokes[False, True][F], True), (arcs["out", True][F], True), (spokes[True, True][T], False),
                     (arcs["in", True][T], False)],
            "first": [(spokes[False, False][F], True), (uprights["out", False][F], True),
                      (spokes[False, True][T], False), (uprights["in", False][T], False)],
            "last": [(uprights["in", True][F], True), (spokes[True, True][F], True), (uprights["out", True][T], False),
                     (spokes[True, False][T], False)],
        }
        senses = {"out": True, "in": False, "low": False, "high": True, "first": True, "last": True}
        faces = [s.face([s.bound(s.loop(uses), outer=True)], surfaces[name](), senses[name])
                 for name, uses in loops.items()]
        faces += slivers
        rng.shuffle(faces)
        write_solid(s, faces, path)

    return "", area, write


KINDS: dict[str, tuple[str, Callable[[random.Random], Model]]] = {
    "between": ("a face between a side of a patch and an edge that coincides with it", between),
    "alone": ("a face without area between two patches", alone),
    "no_length": ("a patch with edges of no length at its corners", no_length),
    "vertices_apart": ("a patch whose corners are two vertices each, within the accuracy", vertices_apart),
    "slit": ("a patch with a hole of two points", slit),
    "folded": ("a patch with a hole of one edge that returns on its own way", folded),
    "spike": ("a patch whose border has a spike of no width", spike),
    "thin": ("a thin patch beside another, wider than the accuracy", thin),
    "sector": ("a solid with faces of no area between its faces", sector),
}

if __name__ == "__main__":
    main(__doc__, FOLDER, KINDS, kept=2)
