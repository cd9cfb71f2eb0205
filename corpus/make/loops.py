"""Trims that break tessellators: no seam, poles, windings, slivers, touching and reversed loops."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from case import case
from part21 import Point, Step, Use, newell, numbers, real, refs, unit, write_sheet, write_solid

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
DOWN = (0, 0, -1)
O = (0, 0, 0)


def block(step: Step, low: Point, high: Point, skip: str = "") -> list[str]:
    """The planar faces of a box, outwards; letters in `skip` (top, bottom) are left out."""
    (a, b, c), (d, e, f) = low, high
    lower, upper = [(a, b, c), (d, b, c), (d, e, c), (a, e, c)], [(a, b, f), (d, b, f), (d, e, f), (a, e, f)]
    faces = [step.flat([lower[i], lower[(i + 1) % 4], upper[(i + 1) % 4], upper[i]]) for i in range(4)]
    if "bottom" not in skip:
        faces.append(step.flat(lower[::-1]))
    if "top" not in skip:
        faces.append(step.flat(upper))
    return faces


def band(step: Step, surface: str, left: Use, right: Use, sense: bool = True) -> str:
    """A face between two closed edges."""
    return step.face([step.bound(step.loop([left]), outer=True), step.bound(step.loop([right]))], surface, sense)


@case("cylinder_no_seam", "a cylinder between two circles, without a seam", solids=1, closed=True, faces=3)
def cylinder_no_seam(path: Path) -> None:
    s = Step(path.stem)
    low, high = s.ring(O, Z, X, 10), s.ring((0, 0, 25), Z, X, 10)
    side = band(s, s.elementary("CYLINDRICAL_SURFACE", O, Z, X, 10), (low, True), (high, False))
    write_solid(s, [side, s.disc(low, False, O, DOWN, X), s.disc(high, True, (0, 0, 25), Z, X)], path)


@case("cylinder_oblique", "a cylinder cut by a slanted plane: an ellipse winds round it, no seam", solids=1,
      closed=True, faces=3)
def cylinder_oblique(path: Path) -> None:
    s = Step(path.stem)
    low = s.ring(O, Z, X, 10)
    normal, major = unit((-1, 0, 2)), unit((2, 0, 1))
    start = (10, 0, 25)
    frame = s.axes((0, 0, 20), normal, major)
    ellipse = s.add(f"ELLIPSE('',{frame},{real(math.hypot(10, 5))},10.)")
    high = s.edge(start, start, ellipse)
    side = band(s, s.elementary("CYLINDRICAL_SURFACE", O, Z, X, 10), (low, True), (high, False))
    write_solid(s, [side, s.disc(low, False, O, DOWN, X), s.disc(high, True, (0, 0, 20), normal, major)], path)


@case("sphere_cap", "a sphere's cap with one circle round the pole", solids=1, closed=True, faces=2)
def sphere_cap(path: Path) -> None:
    s = Step(path.stem)
    ring = s.ring((0, 0, -6), Z, X, 8)
    cap = s.face([s.bound(s.loop([(ring, True)]), outer=True)], s.elementary("SPHERICAL_SURFACE", O, Z, X, 10))
    write_solid(s, [cap, s.disc(ring, False, (0, 0, -6), DOWN, X)], path)


@case("sphere_side_cut", "a sphere less a cap across its seam: the loop is a hole, both poles lie inside", solids=1,
      closed=True, faces=2)
def sphere_side_cut(path: Path) -> None:
    s = Step(path.stem)
    ring = s.ring((8, 0, 0), X, Y, 6)
    rest = s.face([s.bound(s.loop([(ring, False)]), outer=True)], s.elementary("SPHERICAL_SURFACE", O, Z, X, 10))
    write_solid(s, [rest, s.disc(ring, True, (8, 0, 0), X, Y)], path)


@case("sphere_band", "a sphere between two circles of latitude, no seam", solids=1, closed=True, faces=3)
def sphere_band(path: Path) -> None:
    s = Step(path.stem)
    low, high = s.ring((0, 0, -6), Z, X, 8), s.ring((0, 0, 8), Z, X, 6)
    side = band(s, s.elementary("SPHERICAL_SURFACE", O, Z, X, 10), (low, True), (high, False))
    write_solid(s, [side, s.disc(low, False, (0, 0, -6), DOWN, X), s.disc(high, True, (0, 0, 8), Z, X)], path)


@case("sphere_lunes", "a sphere in three lunes that meet at the poles", solids=1, closed=True, faces=3)
def sphere_lunes(path: Path) -> None:
    s = Step(path.stem)
    meridians = []
    for k in range(3):
        a = math.tau * k / 3 + 0.2
        x = (math.cos(a), math.sin(a), 0)
        meridians.append(s.edge((0, 0, -10), (0, 0, 10), s.circle(O, (x[1], -x[0], 0), DOWN, 10)))
    faces = []
    for k in range(3):
        loop = s.loop([(meridians[(k + 1) % 3], True), (meridians[k], False)])
        faces.append(s.face([s.bound(loop, outer=True)], s.elementary("SPHERICAL_SURFACE", O, Z, X, 10)))
    write_solid(s, faces, path)


@case("sphere_pole_on_edge", "a quarter of a ball, tilted: one edge runs over the pole of its sphere", solids=1,
      closed=True, faces=3)
def sphere_pole_on_edge(path: Path) -> None:
    s = Step(path.stem)
    # Tilted, so that no sample hits the pole to the last bit.
    x = np.array(unit((3, 1, 2)))
    z = np.array(unit(tuple(np.cross(x, (1, 5, -2)))))
    y = np.cross(z, x)
    x, y, z = (tuple(float(c) for c in axis) for axis in (x, y, z))
    minus = lambda v: tuple(-c for c in v)
    a, b = tuple(10 * c for c in x), tuple(-10 * c for c in x)
    equator, meridian = s.edge(a, b, s.circle(O, z, x, 10)), s.edge(a, b, s.circle(O, minus(y), x, 10))
    line, along = s.segment(b, a)
    quarter = s.loop([(equator, True), (meridian, False)])
    low, wall = s.loop([(equator, False), (line, not along)]), s.loop([(meridian, True), (line, along)])
    faces = [
        s.face([s.bound(quarter, outer=True)], s.elementary("SPHERICAL_SURFACE", O, z, x, 10)),
        s.face([s.bound(low, outer=True)], s.plane(O, minus(z), x)),
        s.face([s.bound(wall, outer=True)], s.plane(O, minus(y), x)),
    ]
    write_solid(s, faces, path)


@case("crescent", "two arcs of different radius that touch where they meet: coarse chords cross", solids=1, closed=True,
      faces=5)
def crescent(path: Path) -> None:
    s = Step(path.stem)
    up = lambda p, z: (p[0], p[1], z)
    p, q, r = (-26, 0), (32, 0), (26, 0)
    outer = [s.edge(up(q, z), up(p, z), s.circle((3, 0, z), Z, X, 29)) for z in (0, 5)]
    inner = [s.edge(up(r, z), up(p, z), s.circle((0, 0, z), Z, X, 26)) for z in (0, 5)]

    def side(edge: list[str], start: Point, end: Point, surface: str, sense: bool) -> str:
        uses = [(edge[0], True), s.segment(up(end, 0), up(end, 5)), (edge[1], False), s.segment(up(start, 5), up(start, 0))]
        if not sense:
            uses = [(e, not forward) for e, forward in reversed(uses)]
        return s.face([s.bound(s.loop(uses), outer=True)], surface, sense)

    ends = [s.segment(up(r, z), up(q, z)) for z in (0, 5)]
    turned = lambda use: (use[0], not use[1])
    top = s.loop([ends[1], (outer[1], True), (inner[1], False)])
    bottom = s.loop([(inner[0], True), (outer[0], False), turned(ends[0])])
    faces = [
        side(outer, q, p, s.elementary("CYLINDRICAL_SURFACE", (3, 0, 0), Z, X, 29), True),
        side(inner, r, p, s.elementary("CYLINDRICAL_SURFACE", O, Z, X, 26), False),
        s.flat([up(r, 0), up(q, 0), up(q, 5), up(r, 5)]),
        s.face([s.bound(top, outer=True)], s.plane((0, 0, 5), Z, X)),
        s.face([s.bound(bottom, outer=True)], s.plane(O, DOWN, X)),
    ]
    write_solid(s, faces, path)


@case("crescent_thin", "a crescent one micrometre thick between two circles whose chords are not alike", solids=1,
      closed=True, faces=5)
def crescent_thin(path: Path) -> None:
    s = Step(path.stem)
    up = lambda p, z: (p[0], p[1], z)
    radius, shift, height, cut = 3.0, 0.001, 1.0, math.radians(110)
    high, low = (shift / 2, math.sqrt(radius**2 - shift**2 / 4)), (shift / 2, -math.sqrt(radius**2 - shift**2 / 4))
    middle = (shift + radius * math.cos(cut), radius * math.sin(cut))
    arc = lambda x, p, q: [s.edge(up(p, z), up(q, z), s.circle((x, 0, z), Z, X, radius)) for z in (0, height)]
    outer, upper, lower = arc(0, high, low), arc(shift, high, middle), arc(shift, middle, low)

    def side(edge: list[str], start: Point, end: Point, x: float, sense: bool) -> str:
        walls = [s.segment(up(end, 0), up(end, height)), s.segment(up(start, height), up(start, 0))]
        uses = [(edge[0], True), walls[0], (edge[1], False), walls[1]]
        if not sense:
            uses = [(e, not forward) for e, forward in reversed(uses)]
        surface = s.elementary("CYLINDRICAL_SURFACE", (x, 0, 0), Z, X, radius)
        return s.face([s.bound(s.loop(uses), outer=True)], surface, sense)

    top = s.loop([(outer[1], True), (lower[1], False), (upper[1], False)])
    bottom = s.loop([(upper[0], True), (lower[0], True), (outer[0], False)])
    faces = [
        side(outer, high, low, 0, True),
        side(upper, high, middle, shift, False),
        side(lower, middle, low, shift, False),
        s.face([s.bound(top, outer=True)], s.plane((0, 0, height), Z, X)),
        s.face([s.bound(bottom, outer=True)], s.plane(O, DOWN, X)),
    ]
    write_solid(s, faces, path)


def whole(path: Path, kind: str, values: tuple[float, ...], vertex: Point | None) -> None:
    """A closed surface as one face: no loop at all, or a vertex loop."""
    s = Step(path.stem)
    bounds = []
    if vertex is not None:
        bounds = [s.bound(s.add(f"VERTEX_LOOP('',{s.vertex(vertex)})"), outer=True)]
    write_solid(s, [s.face(bounds, s.elementary(kind, O, Z, X, *values))], path)


@case("sphere_no_loop", "a whole sphere: a face with no loop", solids=1, closed=True, faces=1)
def sphere_no_loop(path: Path) -> None:
    whole(path, "SPHERICAL_SURFACE", (10,), None)


@case("sphere_vertex_loop", "a whole sphere: a vertex loop at the pole", solids=1, closed=True, faces=1)
def sphere_vertex_loop(path: Path) -> None:
    whole(path, "SPHERICAL_SURFACE", (10,), (0, 0, -10))


@case("torus_no_loop", "a whole torus: a face with no loop", solids=1, closed=True, faces=1)
def torus_no_loop(path: Path) -> None:
    whole(path, "TOROIDAL_SURFACE", (20, 6), None)


@case("torus_vertex_loop", "a whole torus: a vertex loop", solids=1, closed=True, faces=1)
def torus_vertex_loop(path: Path) -> None:
    whole(path, "TOROIDAL_SURFACE", (20, 6), (26, 0, 0))


@case("torus_bands", "two bands of a torus that wind along the large circle, no seam", solids=1, closed=True, faces=2)
def torus_bands(path: Path) -> None:
    s = Step(path.stem)
    torus = s.elementary("TOROIDAL_SURFACE", O, Z, X, 20, 6)
    top, bottom = s.ring((0, 0, 6), Z, X, 20), s.ring((0, 0, -6), Z, X, 20)
    write_solid(s, [band(s, torus, (bottom, True), (top, False)), band(s, torus, (top, True), (bottom, False))], path)


@case("torus_halves", "two halves of a torus that wind along the small circle, no seam", solids=1, closed=True,
      faces=2)
def torus_halves(path: Path) -> None:
    s = Step(path.stem)
    torus = s.elementary("TOROIDAL_SURFACE", O, Z, X, 20, 6)
    a, b = s.ring((20, 0, 0), (0, -1, 0), X, 6), s.ring((-20, 0, 0), Y, (-1, 0, 0), 6)
    write_solid(s, [band(s, torus, (b, True), (a, False)), band(s, torus, (a, True), (b, False))], path)


@case("torus_villarceau", "two bands of a torus between Villarceau circles: loops wind round both ways", solids=1,
      closed=True, faces=2)
def torus_villarceau(path: Path) -> None:
    s = Step(path.stem)
    large, small = 20.0, 6.0
    tilt = math.asin(small / large)
    torus = s.elementary("TOROIDAL_SURFACE", O, Z, X, large, small)
    rings = []
    for side in (1, -1):
        first, second = (0, side, 0), (side * math.cos(tilt), 0, math.sin(tilt))
        normal = (first[1] * second[2], 0, -first[1] * second[0])
        rings.append(s.ring((0, side * small, 0), normal, first, large))
    a, b = rings
    write_solid(s, [band(s, torus, (a, True), (b, False)), band(s, torus, (b, True), (a, False))], path)


@case("cone_one_circle", "a cone's apex inside one circle, no vertex there", solids=1, closed=True, faces=2)
def cone_one_circle(path: Path) -> None:
    s = Step(path.stem)
    ring = s.ring(O, Z, X, 10)
    cone = s.elementary("CONICAL_SURFACE", O, DOWN, X, 10, math.atan2(10, 20))
    side = s.face([s.bound(s.loop([(ring, True)]), outer=True)], cone)
    write_solid(s, [side, s.disc(ring, False, O, DOWN, X)], path)


@case("cone_vertex_loop", "a cone with a vertex loop at its apex", solids=1, closed=True, faces=2)
def cone_vertex_loop(path: Path) -> None:
    s = Step(path.stem)
    ring = s.ring((0, 0, 20), Z, X, 10)
    cone = s.elementary("CONICAL_SURFACE", (0, 0, 10), Z, X, 5, math.atan2(10, 20))
    apex = s.bound(s.add(f"VERTEX_LOOP('',{s.vertex(O)})"))
    side = s.face([s.bound(s.loop([(ring, False)]), outer=True), apex], cone)
    write_solid(s, [side, s.disc(ring, True, (0, 0, 20), Z, X)], path)


@case("cone_halves", "two half cones whose edges meet at the apex", solids=1, closed=True, faces=3)
def cone_halves(path: Path) -> None:
    s = Step(path.stem)
    a, b, apex = (10, 0, 20), (-10, 0, 20), O
    circle = s.circle((0, 0, 20), Z, X, 10)
    front, back = s.edge(b, a, circle), s.edge(a, b, circle)
    up_a, up_b = s.segment(apex, a)[0], s.segment(apex, b)[0]
    cone = s.elementary("CONICAL_SURFACE", (0, 0, 20), Z, X, 10, math.atan2(10, 20))
    half = lambda arc, start, end: s.face([s.bound(s.loop([(start, True), (arc, False), (end, False)]), outer=True)],
                                          cone)
    lid = s.face([s.bound(s.loop([(front, True), (back, True)]), outer=True)], s.plane((0, 0, 20), Z, X))
    write_solid(s, [half(front, up_a, up_b), half(back, up_b, up_a), lid], path)


@case("torus_apple", "the outer half of a spindle torus: one circle round a pole that is no sphere's", solids=1,
      closed=True, faces=2)
def torus_apple(path: Path) -> None:
    s = Step(path.stem)
    ring = s.ring(O, Z, X, 14)
    surface = s.add(f"DEGENERATE_TOROIDAL_SURFACE('',{s.axes()},4.,10.,.T.)")
    cap = s.face([s.bound(s.loop([(ring, True)]), outer=True)], surface)
    write_solid(s, [cap, s.disc(ring, False, O, DOWN, X)], path)


@case("torus_lemon", "the inner half of a spindle torus: a lemon's tip", solids=1, closed=True, faces=2)
def torus_lemon(path: Path) -> None:
    s = Step(path.stem)
    ring = s.ring(O, Z, X, 6)
    surface = s.add(f"DEGENERATE_TOROIDAL_SURFACE('',{s.axes()},4.,10.,.F.)")
    cap = s.face([s.bound(s.loop([(ring, True)]), outer=True)], surface, sense=False)
    write_solid(s, [cap, s.disc(ring, False, O, DOWN, X)], path)


def plate(s: Step, order: list[int], outer: int) -> list[str]:
    """A plate with two round holes. The loops of its two large faces come in `order`; `outer` is called
    outer."""
    low, high = (-20, -10, 0), (20, 10, 5)
    faces = block(s, low, high, skip="top bottom")
    corners = [(-20, -10), (20, -10), (20, 10), (-20, 10)]
    centres = [(-9, 0), (9, 2)]
    rings = [[s.ring((x, y, z), Z, X, 4) for x, y in centres] for z in (0, 5)]
    for (x, y), bottom, top in zip(centres, *rings):
        hole = s.elementary("CYLINDRICAL_SURFACE", (x, y, 0), Z, X, 4)
        faces.append(band(s, hole, (top, True), (bottom, False), sense=False))
    for z, normal in ((0, DOWN), (5, Z)):
        up = z == 5
        points = [(x, y, z) for x, y in (corners if up else corners[::-1])]
        loops = [s.polygon(points)] + [s.loop([(ring, not up)]) for ring in rings[int(up)]]
        bounds = [s.bound(loops[i], outer=i == outer) for i in order]
        faces.append(s.face(bounds, s.plane((0, 0, z), normal, X)))
    return faces


@case("outer_loop_last", "the outer loop is listed last and a hole is called FACE_OUTER_BOUND", solids=1, closed=True,
      faces=8)
def outer_loop_last(path: Path) -> None:
    s = Step(path.stem)
    write_solid(s, plate(s, [1, 2, 0], 1), path)


@case("reversed_loops", "planes that face inwards, loops flagged .F.: all legal, all turned round", solids=1,
      closed=True, faces=6)
def reversed_loops(path: Path) -> None:
    s = Step(path.stem)
    a, b, c = 20, 12, 8
    lower, upper = [(0, 0, 0), (a, 0, 0), (a, b, 0), (0, b, 0)], [(0, 0, c), (a, 0, c), (a, b, c), (0, b, c)]
    polygons = [[lower[i], lower[(i + 1) % 4], upper[(i + 1) % 4], upper[i]] for i in range(4)]
    faces = []
    for k, points in enumerate([*polygons, lower[::-1], upper]):
        normal = [-n for n in newell(points)]
        plane = s.plane(points[0], normal, unit([q - p for p, q in zip(points[0], points[1])]))
        turned = k % 2 == 0
        loop = s.polygon(points[::-1] if turned else points)
        faces.append(s.face([s.bound(loop, outer=True, orientation=not turned)], plane, sense=False))
    write_solid(s, faces, path)


@case("holes_wrong_way", "holes that run the same way round as the outer loop", solids=1, closed=True, faces=13)
def holes_wrong_way(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, (0, 0, 0), (30, 20, 6), skip="top bottom")
    outer = [(0, 0), (30, 0), (30, 20), (0, 20)]
    holes = [[(5, 5), (10, 5), (10, 12), (5, 12)], [(20, 8), (25, 8), (22, 14)]]
    at = lambda polygon, z: [(x, y, z) for x, y in polygon]
    for hole in holes:
        n = len(hole)
        bottom, top = at(hole, 0), at(hole, 6)
        faces += [s.flat([bottom[(i + 1) % n], bottom[i], top[i], top[(i + 1) % n]]) for i in range(n)]
    top_loops = [at(outer, 6)] + [at(h, 6) for h in holes]
    bottom_loops = [at(p, 0)[::-1] for p in [outer, *holes]]
    faces += [s.flat(*top_loops), s.flat(*bottom_loops)]
    write_solid(s, faces, path)


@case("nested_loops", "one face of three nested loops: a rim, a groove and the island within", solids=1, closed=True,
      faces=15)
def nested_loops(path: Path) -> None:
    s = Step(path.stem)
    square = lambda r, z: [(-r, -r, z), (r, -r, z), (r, r, z), (-r, r, z)]
    faces = block(s, (-15, -15, 0), (15, 15, 8), skip="top")
    faces.append(s.flat(square(15, 8), square(10, 8)[::-1], square(5, 8)))
    faces.append(s.flat(square(10, 4), square(5, 4)[::-1]))
    for r, inward in ((10, True), (5, False)):
        low, high = square(r, 4), square(r, 8)
        for i in range(4):
            points = [low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]]
            faces.append(s.flat(points[::-1] if inward else points))
    write_solid(s, faces, path)


@case("figure_eight", "a loop that passes twice through one vertex", solids=1, closed=True, faces=7)
def figure_eight(path: Path) -> None:
    s = Step(path.stem)
    left, right = [(-10, 5, 0), (-10, -5, 0)], [(10, -5, 0), (10, 5, 0)]
    bottom = [O, *left, O, *right]
    faces = [s.flat(bottom[::-1])]
    for (p, q), apex in ((left, (-6, 0, 9)), (right, (6, 0, 9))):
        faces += [s.flat([O, p, apex]), s.flat([p, q, apex]), s.flat([q, O, apex])]
    write_solid(s, faces, path)


@case("touching_loops", "a hole that touches the outer loop, and another that touches the hole, each at a vertex",
      solids=1, closed=True, faces=12)
def touching_loops(path: Path) -> None:
    s = Step(path.stem)
    faces = block(s, (0, 0, 0), (30, 20, 10), skip="top")
    outer = [(0, 0, 10), (30, 0, 10), (30, 20, 10), (0, 20, 10)]
    first = [(0, 0, 10), (12, 8, 10), (8, 14, 10)]
    second = [(12, 8, 10), (24, 6, 10), (22, 15, 10)]
    faces.append(s.flat(outer, first[::-1], second[::-1]))
    for pit in (first, second):
        apex = [sum(p[i] for p in pit) / 3 for i in range(2)] + [4.0]
        faces += [s.flat([pit[i], pit[(i + 1) % 3], apex]) for i in range(3)]
    write_solid(s, faces, path)


@case("sliver_loops", "a slot 0.1 micrometre to 0.1 mm wide and edges as short", solids=1, closed=True, faces=10)
def sliver_loops(path: Path) -> None:
    s = Step(path.stem)
    outline = [(0, 0), (20, 0), (20, 10), (10.05, 10), (10.00005, 1), (9.99995, 1), (9.95, 10), (0, 10)]
    n = len(outline)
    at = lambda z: [(x, y, z) for x, y in outline]
    low, high = at(0), at(5)
    faces = [s.flat([low[i], low[(i + 1) % n], high[(i + 1) % n], high[i]]) for i in range(n)]
    write_solid(s, [*faces, s.flat(low[::-1]), s.flat(high)], path)


@case("loop_ends_apart", "edges that share no vertex: their ends are 1e-11 apart, the stated accuracy is 1e-12",
      solids=1, closed=True, faces=6)
def loop_ends_apart(path: Path) -> None:
    s = Step(path.stem, uncertainty=1e-12)
    a, b, c = 20.0, 12.0, 8.0
    lower, upper = [(0, 0, 0), (a, 0, 0), (a, b, 0), (0, b, 0)], [(0, 0, c), (a, 0, c), (a, b, c), (0, b, c)]
    edges: dict[tuple[Point, Point], str] = {}
    jitter = lambda p, k: [x + 1e-11 * ((k * 7 + i * 5) % 3 - 1) for i, x in enumerate(p)]

    def use(p: Point, q: Point) -> Use:
        if (q, p) in edges:
            return edges[q, p], False
        k = len(edges)
        start, end = jitter(p, 2 * k), jitter(q, 2 * k + 1)
        edges[p, q] = s.edge(start, end, s.line(start, end))
        return edges[p, q], True

    faces = []
    polygons = [[lower[i], lower[(i + 1) % 4], upper[(i + 1) % 4], upper[i]] for i in range(4)]
    for points in [*polygons, lower[::-1], upper]:
        loop = s.loop([use(p, q) for p, q in zip(points, [*points[1:], points[0]])])
        x = unit([q - p for p, q in zip(points[0], points[1])])
        faces.append(s.face([s.bound(loop, outer=True)], s.plane(points[0], newell(points), x)))
    write_solid(s, faces, path)


@case("loose_edges", "edges 1 % of the part off the cylinder that they bound", solids=1, closed=True, faces=3)
def loose_edges(path: Path) -> None:
    s = Step(path.stem)
    low, high = s.ring(O, Z, X, 10.3), s.ring((0, 0, 20), Z, X, 10.3)
    side = band(s, s.elementary("CYLINDRICAL_SURFACE", O, Z, X, 10), (low, True), (high, False))
    write_solid(s, [side, s.disc(low, False, O, DOWN, X), s.disc(high, True, (0, 0, 20), Z, X)], path)


@case("pcurve_trims", "a B-spline face trimmed by pcurves that run along its domain's border and cut a corner",
      solids=0, closed=False, faces=1)
def pcurve_trims(path: Path) -> None:
    s = Step(path.stem)
    height = [[0, 3, 1], [2, 5, 0], [1, -2, 4]]
    net = [[(15 * i, 10 * j, height[i][j]) for j in range(3)] for i in range(3)]
    ends = ((0, 1), (3, 3))
    surface = s.spline_surface((2, 2), net, ends, ends)
    at = lambda u, v: _patch(net, u, v)
    corners = [(0, 0), (1, 0), (1, 0.4), (0.5, 1), (0, 1)]
    uses = []
    for p, q in zip(corners, [*corners[1:], corners[0]]):
        curve = _on_patch(s, surface, at, p, q)
        uses.append((s.edge(at(*p), at(*q), curve), True))
    write_sheet(s, [s.face([s.bound(s.loop(uses), outer=True)], surface)], path)


def _patch(net: list[list[Point]], u: float, v: float) -> list[float]:
    """A biquadratic Bezier patch."""
    basis = lambda t: [(1 - t) ** 2, 2 * t * (1 - t), t * t]
    return [sum(basis(u)[i] * basis(v)[j] * net[i][j][k] for i in range(3) for j in range(3)) for k in range(3)]


def _on_patch(s: Step, surface: str, at, p: Point, q: Point) -> str:
    """The image of a straight pcurve: exactly a Bezier curve of degree four, with its pcurve beside it."""
    ts = np.linspace(0, 1, 5)
    values = np.array([at(*((1 - t) * np.array(p) + t * np.array(q))) for t in ts])
    matrix = np.array([[math.comb(4, k) * t**k * (1 - t) ** (4 - k) for k in range(5)] for t in ts])
    control = np.linalg.solve(matrix, values)
    curve = s.spline(4, control.tolist(), (0, 1), (5, 5))
    flat = [s.add(f"CARTESIAN_POINT('',{numbers(c)})") for c in (p, q)]
    line = s.add(f"B_SPLINE_CURVE_WITH_KNOTS('',1,{refs(flat)},.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.)")
    context = s.add("(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()"
                    "REPRESENTATION_CONTEXT('2D',''))")
    definition = s.add(f"DEFINITIONAL_REPRESENTATION('',({line}),{context})")
    pcurve = s.add(f"PCURVE('',{surface},{definition})")
    return s.add(f"SURFACE_CURVE('',{curve},({pcurve}),.PCURVE_S1.)")
