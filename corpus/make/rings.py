"""Faces of surfaces of revolution by their profiles, with areas by closed forms."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from part21 import Point, Step, Use, cross, unit, write_sheet

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


# What the file tests beyond its kind, its area, and what writes it.
Model = tuple[str, float, Callable[[Path], None]]


def sheet(bands: Callable[[], list[Band]], rng: random.Random | None, start: float = 0.0) -> Model:
    made = bands()

    def write(path: Path) -> None:
        s = Step(path.stem)
        f = turned(rng)
        write_sheet(s, [band.face(s, f, start) for band in made], path)

    return "", sum(band.area() for band in made), write
