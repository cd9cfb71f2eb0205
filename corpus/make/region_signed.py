"""Signed, flat, huge and offset surfaces, and bounded ones."""

from __future__ import annotations

import math
import random
from pathlib import Path

from part21 import Step, flag, real, refs, write_sheet
from rings import TAU, Band, Frame, Model, cone, cylinder, meridian, parallel, sheet, sphere, torus, turned


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
