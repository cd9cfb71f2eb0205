"""Bands of signed surfaces in IGES and BREP."""

from __future__ import annotations

from pathlib import Path

from brep_text import Brep
from iges_text import Iges
from rings import TAU, Ring, sphere, torus


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
