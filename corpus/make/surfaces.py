"""Surfaces that an ordinary kernel does not write: high degree, odd weights and knots, collapsed rows,
bounded ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import cadquery as cq

from case import case
from loops import DOWN, O, X, Y, Z, band
from occ import write_shape
from part21 import Knots, Point, Step, numbers, real, refs, unit, write_sheet, write_solid

Net = Sequence[Sequence[Point]]
Weights = Sequence[Sequence[float]]


def clamped(degree: int, count: int) -> Knots:
    """Knots 0, 1, 2 ... clamped at both ends, for `count` control points."""
    inner = count - degree - 1
    return list(range(inner + 2)), [degree + 1] + [1] * inner + [degree + 1]


def patch(s: Step, degrees: tuple[int, int], net: Net, u: Knots | None = None, v: Knots | None = None,
          weights: Weights | None = None) -> str:
    """A face over the whole of a clamped patch; its four edges are the patch's own border curves."""
    u = u or clamped(degrees[0], len(net))
    v = v or clamped(degrees[1], len(net[0]))
    surface = s.spline_surface(degrees, net, u, v, weights)
    column = lambda table, j: [row[j] for row in table]
    borders = [(degrees[0], column(net, 0), u, weights and column(weights, 0), True),
               (degrees[1], net[-1], v, weights and weights[-1], True),
               (degrees[0], column(net, -1), u, weights and column(weights, -1), False),
               (degrees[1], net[0], v, weights and weights[0], False)]
    uses = []
    for degree, points, (knots, mults), w, sense in borders:
        if all(p == points[0] for p in points):
            continue
        curve = s.spline(degree, points, knots, mults, w)
        uses.append((s.edge(points[0], points[-1], curve), sense))
    return s.face([s.bound(s.loop(uses), outer=True)], surface)


def grid(nu: int, nv: int, height: Callable[[float, float], float], size: float = 40) -> list[list[Point]]:
    """A net over a square; `height` takes 0..1."""
    at = lambda i, n: i / (n - 1)
    return [[(size * at(i, nu), size * at(j, nv), height(at(i, nu), at(j, nv))) for j in range(nv)]
            for i in range(nu)]


def waves(x: float, y: float) -> float:
    return 6 * math.sin(9 * x) * math.cos(7 * y) + 3 * x * y


@case("degree_25", "a patch of degree 25 both ways", solids=0, closed=False, faces=1)
def degree_25(path: Path) -> None:
    s = Step(path.stem)
    write_sheet(s, [patch(s, (25, 25), grid(26, 26, lambda x, y: 3 * waves(x, y)))], path)


@case("degree_100", "a patch of degree 100 by 3", solids=0, closed=False, faces=1)
def degree_100(path: Path) -> None:
    s = Step(path.stem)
    write_sheet(s, [patch(s, (100, 3), grid(101, 4, lambda x, y: 40 * math.sin(40 * x) + 5 * y * y))], path)


@case("degree_mixed", "degree 1 by 9 with inner knots, rational", solids=0, closed=False, faces=1)
def degree_mixed(path: Path) -> None:
    s = Step(path.stem)
    net = grid(4, 12, waves)
    weights = [[1 + 0.8 * ((3 * i + 5 * j) % 4) for j in range(12)] for i in range(4)]
    write_sheet(s, [patch(s, (1, 9), net, weights=weights)], path)


@case("knots_over_degree", "inner knots of multiplicity degree + 1: two stacked control points each", solids=0,
      closed=False, faces=1)
def knots_over_degree(path: Path) -> None:
    s = Step(path.stem)
    half = grid(4, 4, waves)
    shifted = [[(x + 40, y, z) for x, y, z in row] for row in grid(4, 4, lambda x, y: waves(1 - x, y))]
    net = [*half, *shifted]
    net[4] = net[3]
    write_sheet(s, [patch(s, (3, 3), net, u=((0, 1, 2), (4, 4, 4)))], path)


@case("stacked_points", "coincident inner control points and a flat block within a curved patch", solids=0,
      closed=False, faces=1)
def stacked_points(path: Path) -> None:
    s = Step(path.stem)
    net = grid(8, 8, lambda x, y: 0.0 if 0.2 < x < 0.8 and 0.2 < y < 0.8 else waves(x, y))
    net[3][3] = net[3][4] = net[4][3] = net[4][4]
    write_sheet(s, [patch(s, (3, 3), net)], path)


@case("weight_zero", "a rational patch with one inner weight of zero", solids=0, closed=False, faces=1)
def weight_zero(path: Path) -> None:
    s = Step(path.stem)
    weights = [[0.0 if (i, j) == (2, 2) else 1.0 for j in range(5)] for i in range(5)]
    write_sheet(s, [patch(s, (3, 3), grid(5, 5, waves), weights=weights)], path)


@case("weight_negative", "a rational patch with one negative inner weight; its denominator stays positive", solids=0,
      closed=False, faces=1)
def weight_negative(path: Path) -> None:
    s = Step(path.stem)
    weights = [[-0.2 if (i, j) == (1, 2) else 1.0 for j in range(4)] for i in range(4)]
    write_sheet(s, [patch(s, (3, 3), grid(4, 4, waves), weights=weights)], path)


@case("weight_range", "weights from 0.001 to 1000 on one patch", solids=0, closed=False, faces=1)
def weight_range(path: Path) -> None:
    s = Step(path.stem)
    weights = [[10.0 ** ((2 * i + j) % 7 - 3) for j in range(5)] for i in range(5)]
    write_sheet(s, [patch(s, (3, 3), grid(5, 5, waves), weights=weights)], path)


@case("folded_strip", "a strip of degree 1 folded at right angles; the face ends at a fold", solids=0, closed=False, faces=1)
def folded_strip(path: Path) -> None:
    s = Step(path.stem)
    corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 20.0), (10.0, 20.0)]
    at = lambda i, z: (*corners[i], z)
    net = [[at(i, 0.0), at(i, 5.0)] for i in range(len(corners))]
    surface = s.spline_surface((1, 1), net, (tuple(range(6)), (2, 1, 1, 1, 1, 2)), ((0, 1), (2, 2)))
    around = [at(i, 0.0) for i in range(4)] + [at(i, 5.0) for i in reversed(range(4))]
    uses = [s.segment(a, b) for a, b in zip(around, around[1:] + around[:1])]
    write_sheet(s, [s.face([s.bound(s.loop(uses), outer=True)], surface)], path)


@case("leaf_thin", "a parallelogram and a patch on it, nearer together than the tolerance", solids=1, closed=True, faces=2)
def leaf_thin(path: Path) -> None:
    s = Step(path.stem)
    height = lambda i, j: 0.02 if 0 < i < 3 and 0 < j < 3 else 0.0
    net = [[(10.0 * i + 4.0 * j, 6.0 * j, height(i, j)) for j in range(4)] for i in range(4)]
    ends = ((0, 1), (4, 4))
    a, b, c, d = net[0][0], net[3][0], net[3][3], net[0][3]
    sides = [s.segment(p, q) for p, q in ((a, b), (b, c), (c, d), (d, a))]
    upper = s.face([s.bound(s.loop(sides), outer=True)], s.spline_surface((3, 3), net, ends, ends))
    back = [(edge, not sense) for edge, sense in reversed(sides)]
    write_solid(s, [upper, s.face([s.bound(s.loop(back), outer=True)], s.plane(O, DOWN, X))], path)


@case("octant", "an octant of a ball as a rational patch with a collapsed row", solids=1, closed=True, faces=4)
def octant(path: Path) -> None:
    s, r, h = Step(path.stem), 10.0, math.sqrt(0.5)
    net = [[(r, 0, 0), (r, 0, r), (0, 0, r)], [(r, r, 0), (r, r, r), (0, 0, r)], [(0, r, 0), (0, r, r), (0, 0, r)]]
    weights = [[1, h, 1], [h, 0.5, h], [1, h, 1]]
    ends = ((0, 1), (3, 3))
    surface = s.spline_surface((2, 2), net, ends, ends, weights)
    a, b, c = net[0][0], net[2][0], net[0][2]
    arc = lambda points: s.edge(points[0], points[2], s.spline(2, points, (0, 1), (3, 3), (1, h, 1)))
    low, left, right = arc([row[0] for row in net]), arc(net[0]), arc(net[2])
    round_face = s.face([s.bound(s.loop([(low, True), (right, True), (left, False)]), outer=True)], surface)
    quarter = lambda uses, z, x: s.face([s.bound(s.loop(uses), outer=True)], s.plane(O, z, x))
    faces = [round_face,
             quarter([s.segment(O, b), (low, False), s.segment(a, O)], DOWN, X),
             quarter([s.segment(O, a), (left, True), s.segment(c, O)], (0, -1, 0), X),
             quarter([s.segment(O, c), (right, False), s.segment(b, O)], (-1, 0, 0), Y)]
    write_solid(s, faces, path)


@case("spline_ball", "a sphere as one closed rational B-spline: a seam and two collapsed rows", solids=1, closed=True,
      faces=1)
def spline_ball(path: Path) -> None:
    s, r, h = Step(path.stem), 10.0, math.sqrt(0.5)
    circle = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    profile = [(0, -r), (r, -r), (r, 0), (r, r), (0, r)]
    net = [[(x * rho, y * rho, z) for rho, z in profile] for x, y in circle]
    weights = [[(h if i % 2 else 1) * (h if j % 2 else 1) for j in range(5)] for i in range(9)]
    u, v = ((0, 1, 2, 3, 4), (3, 2, 2, 2, 3)), ((0, 1, 2), (3, 2, 3))
    surface = s.spline_surface((2, 2), net, u, v, weights, closed=(True, False))
    seam = s.edge(net[0][0], net[0][4], s.spline(2, net[0], *v, weights[0]))
    write_solid(s, [s.face([s.bound(s.loop([(seam, True), (seam, False)]), outer=True)], surface)], path)


@case("spline_cyclic", "a tube of unclamped cyclic knots between two closed B-spline rims, no seam", solids=1,
      closed=True, faces=3)
def spline_cyclic(path: Path) -> None:
    s, n = Step(path.stem), 8
    star = [((10 + 3 * (k % 2)) * math.cos(math.tau * k / n), (10 + 3 * (k % 2)) * math.sin(math.tau * k / n))
            for k in range(n)]
    around = [*star, *star[:3]]
    u = (list(range(-3, n + 4)), [1] * (n + 7))
    net = [[(x, y, 0), (1.2 * x, 1.2 * y, 10), (x, y, 20)] for x, y in around]
    surface = s.spline_surface((3, 2), net, u, ((0, 1), (3, 3)), closed=(True, False))

    def rim(z: float) -> str:
        start = [sum(w * around[i][k] for i, w in enumerate((1 / 6, 4 / 6, 1 / 6))) for k in range(2)] + [z]
        return s.edge(start, start, s.spline(3, [(x, y, z) for x, y in around], *u, closed=True))

    low, high = rim(0), rim(20)
    write_solid(s, [band(s, surface, (low, True), (high, False)), s.disc(low, False, O, DOWN, X),
                    s.disc(high, True, (0, 0, 20), Z, X)], path)


@case("spline_forms", "BEZIER, UNIFORM, QUASI_UNIFORM and PIECEWISE_BEZIER surfaces side by side", solids=0,
      closed=False, faces=4)
def spline_forms(path: Path) -> None:
    s, faces = Step(path.stem), []
    kinds = [("BEZIER", 4), ("QUASI_UNIFORM", 6), ("PIECEWISE_BEZIER", 7), ("UNIFORM", 6)]
    for k, (kind, n) in enumerate(kinds):
        net = [[(x + 45 * k, y, z) for x, y, z in row] for row in grid(n, 4, waves)]
        faces.append(_form_face(s, kind, net))
    write_sheet(s, faces, path)


def _form_face(s: Step, kind: str, net: Net) -> str:
    """A face over a surface whose knots are given by the name of its entity alone. Its rows across are cubic
    too."""
    control = "(" + ",".join(refs([s.point(p) for p in row]) for row in net) + ")"
    surface = s.add(f"{kind}_SURFACE('',3,3,{control},.UNSPECIFIED.,.F.,.F.,.F.)")
    corner = lambda i, j: _corner(kind, net, i, j)
    uses = []
    for side, (start, end) in enumerate((((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0)))):
        along_u = side % 2 == 0
        points = _row(kind, net, start if side < 2 else end, along_u)
        name = kind if along_u or kind == "UNIFORM" else "BEZIER"
        ids = refs([s.point(p) for p in points])
        curve = s.add(f"{name}_CURVE('',3,{ids},.UNSPECIFIED.,.F.,.F.)")
        forward = side < 2
        ends = (corner(*start), corner(*end)) if forward else (corner(*end), corner(*start))
        uses.append((s.edge(*ends, curve), forward))
    return s.face([s.bound(s.loop(uses), outer=True)], surface)


THIRDS = (1 / 6, 4 / 6, 1 / 6)


def _blend(points: Sequence[Point]) -> list[float]:
    """Where a uniform cubic segment begins."""
    return [sum(w * p[k] for w, p in zip(THIRDS, points)) for k in range(3)]


def _row(kind: str, net: Net, corner: tuple[int, int], along_u: bool) -> list[Point]:
    """Control points of a border curve."""
    i, j = corner
    if kind != "UNIFORM":
        return [row[-1 if j else 0] for row in net] if along_u else list(net[-1 if i else 0])
    if along_u:
        return [_blend(row[1:4] if j else row[:3]) for row in net]
    rows = net[-3:] if i else net[:3]
    return [_blend([row[k] for row in rows]) for k in range(len(net[0]))]


def _corner(kind: str, net: Net, i: int, j: int) -> Point:
    points = _row(kind, net, (0, j), True)
    if kind == "UNIFORM":
        return _blend(points[-3:] if i else points[:3])
    return points[-1 if i else 0]


@case("revolution_no_seam", "a revolved B-spline between two circles, no seam", solids=1, closed=True, faces=3)
def revolution_no_seam(path: Path) -> None:
    s = Step(path.stem)
    profile = s.spline(3, [(8, 0, 0), (14, 0, 6), (3, 0, 12), (9, 0, 18)], (0, 1), (4, 4))
    surface = s.add(f"SURFACE_OF_REVOLUTION('',{profile},{s.axis()})")
    low, high = s.ring(O, Z, X, 8), s.ring((0, 0, 18), Z, X, 9)
    write_solid(s, [band(s, surface, (low, True), (high, False)), s.disc(low, False, O, DOWN, X),
                    s.disc(high, True, (0, 0, 18), Z, X)], path)


@case("offset_cylinder", "OFFSET_SURFACE of a cylinder", solids=1, closed=True, faces=3)
def offset_cylinder(path: Path) -> None:
    s = Step(path.stem)
    basis = s.elementary("CYLINDRICAL_SURFACE", O, Z, X, 8)
    surface = s.add(f"OFFSET_SURFACE('',{basis},2.,.F.)")
    low, high = s.ring(O, Z, X, 10), s.ring((0, 0, 20), Z, X, 10)
    write_solid(s, [band(s, surface, (low, True), (high, False)), s.disc(low, False, O, DOWN, X),
                    s.disc(high, True, (0, 0, 20), Z, X)], path)


@case("offset_bspline", "a thickened B-spline sheet: its other side is an OFFSET_SURFACE", solids=1, closed=True)
def offset_bspline(path: Path) -> None:
    points = [[cq.Vector(10 * i, 10 * j, 3 * math.sin(1.3 * i) * math.cos(j)) for j in range(4)] for i in range(4)]
    write_shape(cq.Face.makeSplineApprox(points, tol=0.05, minDeg=3, maxDeg=5).thicken(2).wrapped, path)


@case("trimmed_surface", "RECTANGULAR_TRIMMED_SURFACE as the geometry of a face", solids=1, closed=True, faces=3)
def trimmed_surface(path: Path) -> None:
    s = Step(path.stem)
    basis = s.elementary("CYLINDRICAL_SURFACE", O, Z, X, 10)
    surface = s.add(f"RECTANGULAR_TRIMMED_SURFACE('',{basis},0.,{real(math.tau)},0.,25.,.T.,.T.)")
    low, high = s.ring(O, Z, X, 10), s.ring((0, 0, 25), Z, X, 10)
    write_solid(s, [band(s, surface, (low, True), (high, False)), s.disc(low, False, O, DOWN, X),
                    s.disc(high, True, (0, 0, 25), Z, X)], path)


@case("trimmed_set", "RECTANGULAR_TRIMMED_SURFACEs of a sphere and a torus without topology", solids=0, closed=False,
      faces=2)
def trimmed_set(path: Path) -> None:
    s = Step(path.stem)
    ball = s.elementary("SPHERICAL_SURFACE", O, Z, X, 10)
    ring = s.elementary("TOROIDAL_SURFACE", (40, 0, 0), Z, X, 12, 4)
    items = [s.add(f"RECTANGULAR_TRIMMED_SURFACE('',{ball},0.3,2.4,-0.6,1.1,.T.,.T.)"),
             s.add(f"RECTANGULAR_TRIMMED_SURFACE('',{ring},5.,7.5,1.,4.,.T.,.T.)")]
    whole = s.add(f"GEOMETRIC_SET('',{refs(items)})")
    s.part([s.axes(), whole], "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION")
    s.write(path)


@case("curve_bounded", "CURVE_BOUNDED_SURFACE: a B-spline patch within curves on it, without topology", solids=0,
      closed=False, faces=1)
def curve_bounded(path: Path) -> None:
    s = Step(path.stem)
    net = grid(4, 4, waves)
    ends = clamped(3, 4)
    surface = s.spline_surface((3, 3), net, ends, ends)
    corners = [(0.2, 0.1), (0.9, 0.3), (0.7, 0.9), (0.1, 0.8)]
    segments = []
    for p, q in zip(corners, [*corners[1:], corners[0]]):
        pcurve = _straight_pcurve(s, surface, p, q)
        segments.append(s.add(f"COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,{pcurve})"))
    border = s.add(f"OUTER_BOUNDARY_CURVE('',{refs(segments)},.F.)")
    bounded = s.add(f"CURVE_BOUNDED_SURFACE('',{surface},({border}),.F.)")
    whole = s.add(f"GEOMETRIC_SET('',({bounded}))")
    s.part([s.axes(), whole], "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION")
    s.write(path)


@case("curve_bounded_pole", "CURVE_BOUNDED_SURFACE round an octant of a ball: one of its four curves is a single point",
      solids=0, closed=False, faces=1)
def curve_bounded_pole(path: Path) -> None:
    s, r, h = Step(path.stem), 10.0, math.sqrt(0.5)
    net = [[(r, 0, 0), (r, 0, r), (0, 0, r)], [(r, r, 0), (r, r, r), (0, 0, r)], [(0, r, 0), (0, r, r), (0, 0, r)]]
    ends = ((0, 1), (3, 3))
    surface = s.spline_surface((2, 2), net, ends, ends, [[1, h, 1], [h, 0.5, h], [1, h, 1]])
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    pcurves = [_straight_pcurve(s, surface, p, q) for p, q in zip(corners, [*corners[1:], corners[0]])]
    segments = [s.add(f"COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,{pcurve})") for pcurve in pcurves]
    border = s.add(f"OUTER_BOUNDARY_CURVE('',{refs(segments)},.F.)")
    bounded = s.add(f"CURVE_BOUNDED_SURFACE('',{surface},({border}),.F.)")
    s.part([s.axes(), s.add(f"GEOMETRIC_SET('',({bounded}))")], "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION")
    s.write(path)


def _straight_pcurve(s: Step, surface: str, p: Point, q: Point) -> str:
    ids = refs([s.add(f"CARTESIAN_POINT('',{numbers(c)})") for c in (p, q)])
    line = s.add(f"B_SPLINE_CURVE_WITH_KNOTS('',1,{ids},.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.)")
    context = s.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()"
                    "REPRESENTATION_CONTEXT('2D',''))")
    definition = s.add(f"DEFINITIONAL_REPRESENTATION('',({line}),{context})")
    return s.add(f"PCURVE('',{surface},{definition})")


@case("curve_kinds", "a prism over arcs of parabola, hyperbola, ellipse, polyline, trimmed and composite curves",
      solids=1, closed=True, faces=8)
def curve_kinds(path: Path) -> None:
    s, height = Step(path.stem), 6.0
    corners = [(0, 0), (12, 0), (22, 8), (20, 16), (12, 20), (0, 20)]
    low = [(x, y, 0) for x, y in corners]
    high = [(x, y, height) for x, y in corners]
    makers = [_parabola, _ellipse, _polyline, _hyperbola, _composite, _trimmed]
    up = s.add(f"VECTOR('',{s.direction(Z)},1.)")
    bottom, top, faces = [], [], []
    for k, make in enumerate(makers):
        p, q = k, (k + 1) % 6
        curve = make(s, low[p], low[q])
        bottom.append(s.edge(low[p], low[q], curve))
        top.append(s.edge(high[p], high[q], make(s, high[p], high[q])))
        surface = s.add(f"SURFACE_OF_LINEAR_EXTRUSION('',{make(s, low[p], low[q])},{up})")
        loop = s.loop([(bottom[k], True), s.segment(low[q], high[q]), (top[k], False), s.segment(high[p], low[p])])
        faces.append(s.face([s.bound(loop, outer=True)], surface))
    lid = lambda uses, z, normal: s.face([s.bound(s.loop(uses), outer=True)], s.plane((0, 0, z), normal, X))
    faces += [lid([(e, False) for e in bottom[::-1]], 0, DOWN), lid([(e, True) for e in top], height, Z)]
    write_solid(s, faces, path)


def _parabola(s: Step, p: Point, q: Point) -> str:
    """Through (0, 0) and (12, 0) with its vertex at (6, -3)."""
    return s.add(f"PARABOLA('',{s.axes((6, -3, p[2]), DOWN, Y)},3.)")


def _ellipse(s: Step, p: Point, q: Point) -> str:
    """A quarter from (12, 0) to (22, 8)."""
    return s.add(f"ELLIPSE('',{s.axes((12, 8, p[2]), Z, X)},10.,8.)")


def _polyline(s: Step, p: Point, q: Point) -> str:
    return s.add(f"POLYLINE('',{refs([s.point(c) for c in (p, (23, 11, p[2]), (19, 13, p[2]), q)])})")


def _hyperbola(s: Step, p: Point, q: Point) -> str:
    """Through both ends; its vertex bulges outwards by half the semi-axis."""
    middle = [(a + b) / 2 for a, b in zip(p, q)]
    along = unit([b - a for a, b in zip(p, q)])
    across = (along[1], -along[0], 0)
    half = math.dist(p, q) / 2
    semi, imaginary = 4.0, half / math.sqrt(1.5**2 - 1)
    centre = [m + 1.5 * semi * a for m, a in zip(middle, across)]
    inward = [-a + 0.0 for a in across]
    return s.add(f"HYPERBOLA('',{s.axes(centre, DOWN, inward)},{real(semi)},{real(imaginary)})")


def _composite(s: Step, p: Point, q: Point) -> str:
    """Two straight pieces and an arc as one curve."""
    z = p[2]
    a, b = (9, 20, z), (3, 20, z)
    arc = s.add(f"TRIMMED_CURVE('',{s.circle((6, 20, z), Z, X, 3)},(PARAMETER_VALUE(0.)),"
                f"(PARAMETER_VALUE({real(math.pi)})),.T.,.PARAMETER.)")
    straight = lambda c, d: s.add(f"TRIMMED_CURVE('',{s.line(c, d)},({s.point(c)}),({s.point(d)}),.T.,.CARTESIAN.)")
    pieces = [s.add(f"COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,{c})") for c in (straight(p, a), arc, straight(b, q))]
    return s.add(f"COMPOSITE_CURVE('',{refs(pieces)},.F.)")


def _trimmed(s: Step, p: Point, q: Point) -> str:
    """A trimmed line, given the wrong way round."""
    return s.add(f"TRIMMED_CURVE('',{s.line(q, p)},(PARAMETER_VALUE(1.)),(PARAMETER_VALUE(0.)),.F.,.PARAMETER.)")
