"""Inventor files to be looked at: the three models by which Krishnamurthy, Khardekar and McMains 2009 show
trimmed drawing, made anew. `iv_files.py` writes them with the others.
"""

from __future__ import annotations

import math

from written import good

HEADER = "#Inventor V2.1 ascii\n\n"
W = math.sqrt(0.5)
RING = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
RING_KNOTS = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
WEIGHTS = [1 if i % 2 == 0 else W for i in range(9)]
UNIT = [(0, 0), (1, 0), (1, 1), (0, 1)]

Section = tuple[float, float, float, float]  # place along the axis, half width, height of the middle, half height


def numbers(values: list[float]) -> str:
    return " ".join(f"{x:.6g}" for x in values)


def points(rows: list[tuple[float, ...]]) -> str:
    return ",\n    ".join(numbers(list(p)) for p in rows)


def surface(net: list[tuple[float, ...]], counts: tuple[int, int], u: list[float], v: list[float], trim: str = "") -> str:
    """A surface over `net`, u running fastest; homogeneous where its points have four numbers."""
    return (
        f"  Coordinate{len(net[0])} {{ point [\n    {points(net)} ] }}\n{trim}"
        f"  NurbsSurface {{ numUControlPoints {counts[0]} numVControlPoints {counts[1]}\n"
        f"    uKnotVector [ {numbers(u)} ] vKnotVector [ {numbers(v)} ] }}\n"
    )


def group(color: tuple[float, float, float], *parts: str) -> str:
    return f"Separator {{\n  Material {{ diffuseColor {numbers(list(color))} }}\n" + "".join(parts) + "}\n"


def polyline(corners: list[tuple[float, float]], first: bool = False) -> str:
    linkage = "" if first else " linkage START_NEW"
    index = " ".join(map(str, [*range(len(corners)), 0]))
    return f"  ProfileCoordinate2 {{ point [ {points(corners)} ] }}\n  LinearProfile {{ index [ {index} ]{linkage} }}\n"


def oval(middle: tuple[float, float], half: tuple[float, float]) -> str:
    """A rational ellipse as one more loop."""
    control = [((middle[0] + half[0] * x) * w, (middle[1] + half[1] * y) * w, w) for (x, y), w in zip(RING, WEIGHTS)]
    return (
        f"  ProfileCoordinate3 {{ point [ {points(control)} ] }}\n"
        f"  NurbsProfile {{ index [ 0 1 2 3 4 5 6 7 8 ] linkage START_NEW knotVector [ {numbers(RING_KNOTS)} ] }}\n"
    )


def hull(sections: list[Section], knots: list[float], axes: str, trim: str = "") -> str:
    """Ellipses along an axis, cubic from one to the next. `axes`: which of x, y, z the axis, the width and
    the height are."""
    net = []
    for along, width, middle, height in sections:
        for (a, b), w in zip(RING, WEIGHTS):
            place = {axes[0]: along, axes[1]: width * a, axes[2]: middle + height * b}
            net.append((place["x"] * w, place["y"] * w, place["z"] * w, w))
    return surface(net, (9, len(sections)), RING_KNOTS, knots, trim)


YELLOW, ORANGE, WHITE, RED = (0.95, 0.76, 0.12), (0.9, 0.4, 0.08), (0.85, 0.86, 0.88), (0.75, 0.12, 0.1)
WOOD = (0.62, 0.45, 0.26)


@good("duck", "three rational surfaces on uneven knots, one of them trimmed where another comes out", faces=3, closed=False)
def duck() -> str:
    body = [(-5.4, 0.02, 2.5, 0.02), (-4.4, 1.2, 1.7, 0.35), (-2.6, 2.6, 0.6, 1.3), (0, 3.0, 0.2, 2.0),
            (2.6, 2.8, 0.3, 2.0), (4.2, 1.9, 0.6, 1.6), (4.8, 0.9, 0.9, 0.8), (4.85, 0.01, 1.0, 0.01)]
    neck = polyline([(0, 0), (4, 0), (4, 5), (0, 5)], first=True) + oval((1, 3.05), (0.3, 0.62))
    head = [(1.4, 1.3, 2.1, 1.3), (2.4, 1.0, 2.3, 1.0), (3.1, 1.0, 2.5, 1.0), (3.8, 1.9, 2.8, 1.9), (5.3, 1.9, 2.9, 1.8),
            (6.1, 1.0, 2.8, 1.0), (6.2, 0.01, 2.8, 0.01)]
    beak = [(4.0, 0.9, 4.2, 0.6), (4.8, 1.0, 4.1, 0.4), (5.7, 1.1, 4.2, 0.22), (6.2, 0.7, 4.3, 0.12), (6.3, 0.01, 4.3, 0.01)]
    return (
        HEADER
        + group(YELLOW, hull(body, [0, 0, 0, 0, 1, 2.2, 3, 4.5, 5, 5, 5, 5], "xyz", neck))
        + group(YELLOW, hull(head, [0, 0, 0, 0, 0.8, 2, 2.5, 3, 3, 3, 3], "zyx"))
        + group(ORANGE, hull(beak, [0, 0, 0, 0, 1.5, 2, 2, 2, 2], "xyz"))
    )


def sheet(corners: list[tuple[float, float, float]], trim: str = "") -> str:
    """A flat patch: its corners at (0, 0), (1, 0), (0, 1), (1, 1)."""
    return surface(corners, (2, 2), [0, 0, 1, 1], [0, 0, 1, 1], trim)


@good("airplane_in_a_box", "closed bodies within a box, seen through trimmed windows: the order of drawing must not show", faces=10, closed=False)
def airplane_in_a_box() -> str:
    x, y, z = 8.0, 7.5, 3.0
    rounded = polyline(UNIT, first=True) + polyline([(0.12, 0.25), (0.2, 0.12), (0.8, 0.12), (0.88, 0.25), (0.88, 0.75),
                                                     (0.8, 0.88), (0.2, 0.88), (0.12, 0.75)])
    three = polyline(UNIT, first=True) + "".join(oval((0.2 + 0.3 * k, 0.5), (0.12, 0.3)) for k in range(3))
    opening = polyline(UNIT, first=True) + oval((0.5, 0.5), (0.44, 0.4))
    box = [
        sheet([(-x, -y, -z), (x, -y, -z), (-x, -y, z), (x, -y, z)], rounded),
        sheet([(x, -y, -z), (x, y, -z), (x, -y, z), (x, y, z)], three),
        sheet([(-x, -y, z), (x, -y, z), (-x, y, z), (x, y, z)], opening),
        sheet([(-x, y, -z), (x, y, -z), (-x, y, z), (x, y, z)]),
        sheet([(-x, -y, -z), (-x, y, -z), (-x, -y, z), (-x, y, z)]),
        sheet([(-x, -y, -z), (x, -y, -z), (-x, y, -z), (x, y, -z)]),
    ]
    fuselage = [(-6, 0.05, 0.3, 0.05), (-5, 0.4, 0.2, 0.4), (-2, 0.8, 0, 0.8), (2, 0.9, 0, 0.9), (5, 0.8, 0, 0.7), (6.2, 0.5, -0.1, 0.4),
                (6.4, 0.02, -0.1, 0.02)]
    wing = [(-6.2, 0.05, -1.6, 0.5), (-3, 0.12, -0.4, 0.9), (0, 0.25, 0.8, 1.6), (3, 0.12, -0.4, 0.9), (6.2, 0.05, -1.6, 0.5)]
    tail = [(-2.4, 0.03, -5.6, 0.3), (-1, 0.06, -5.2, 0.5), (0, 0.1, -4.8, 0.7), (1, 0.06, -5.2, 0.5), (2.4, 0.03, -5.6, 0.3)]
    fin = [(0.2, 0.1, -4.9, 0.8), (1, 0.08, -5.1, 0.6), (1.6, 0.06, -5.4, 0.5), (2.2, 0.03, -5.7, 0.35)]
    five, four = [0, 0, 0, 0, 1, 2, 2, 2, 2], [0, 0, 0, 0, 1, 1, 1, 1]
    return (
        HEADER
        + group(WOOD, *(f"Separator {{\n{face}}}\n" for face in box))
        + group(RED, hull(fuselage, [0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4], "xyz"))
        + group(WHITE, hull(wing, five, "yzx"), hull(tail, five, "yzx"))
        + group(RED, hull(fin, four, "zyx"))
    )


@good("concave_trim", "a curved patch trimmed by polylines with deep notches, a hole with an island in it", faces=2, closed=False)
def concave_trim() -> str:
    comb = [(0.03, 0.03), (0.97, 0.03), (0.97, 0.55)]
    for k in range(6):
        right = 0.97 - 0.155 * k
        comb += [(right - 0.06, 0.55 + 0.42 * (k % 2 + 1) / 2), (right - 0.08, 0.22), (right - 0.155, 0.6)]
    comb += [(0.03, 0.97)]
    star = [(0.5 + r * math.cos(t), 0.11 + 0.4 * r * math.sin(t))
            for k in range(10) for r, t in [((0.16, 0.06)[k % 2], math.pi * k / 5)]]
    island = [(0.47, 0.1), (0.53, 0.1), (0.53, 0.12), (0.47, 0.12)]
    trim = polyline(comb, first=True) + polyline(star) + polyline(island)
    net = [(10.0 * i / 3, 10.0 * j / 3, 1.5 * math.sin(2.1 * i) * math.cos(1.3 * j), 1 + 0.4 * ((i + j) % 2))
           for j in range(4) for i in range(4)]
    net = [(a * w, b * w, c * w, w) for a, b, c, w in net]
    return HEADER + group((0.3, 0.55, 0.75), surface(net, (4, 4), [0, 0, 0, 0, 1, 1, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1], trim))
