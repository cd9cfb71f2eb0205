"""The BREP files of the corpus, and broken ones: one function each.

    python corpus/make/brep_files.py        # writes corpus/brep and corpus/brep/bad with their INDEX.tsv
"""

from __future__ import annotations

import math

from brep_text import Brep
from written import BAD, GOOD, bad, corpus_folder, good, write_all

TURN = 2 * math.pi
X, Y, Z, O = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)


def use(shape: int, sign: str = "+", location: int = 0) -> tuple[str, int, int]:
    return (sign, shape, location)


def box(b: Brep, size: tuple[float, float, float], shuffled: bool = False) -> int:
    """A box from the origin: planes and lines, no parameter curves, as most writers leave them out."""
    corner = [b.vertex(tuple(size[a] * (i >> a & 1) for a in range(3))) for i in range(8)]
    edges: dict[tuple[int, int], int] = {}
    for i in range(8):
        for a in range(3):
            if not i >> a & 1:
                origin = tuple(size[k] * (i >> k & 1) for k in range(3))
                direction = tuple(float(k == a) for k in range(3))
                line = b.curve(1, origin, direction)
                edges[i, i | 1 << a] = b.edge((corner[i], corner[i | 1 << a]), line, (0, size[a]))
    faces = []
    for a in range(3):
        u, v = 1 << (a + 1) % 3, 1 << (a + 2) % 3
        axes = [tuple(float(k == (a + d) % 3) for k in range(3)) for d in range(3)]
        for top in (0, 1):
            base = (1 << a) * top
            ring = [base, base | u, base | u | v, base | v]
            uses = []
            for k in range(4):
                i, j = ring[k], ring[(k + 1) % 4]
                uses.append(use(edges[min(i, j), max(i, j)], "+" if i < j else "-"))
            if shuffled:
                uses = [uses[k] for k in (2, 0, 3, 1)]
            origin = tuple(size[k] * top * (k == a) for k in range(3))
            plane = b.surface(1, origin, axes[0], axes[1], axes[2])
            faces.append(use(b.face(plane, b.wire(*uses)), "+" if top else "-"))
    return b.solid(b.shell(*faces))


@good("box", "planes and lines without parameter curves; half of the faces reversed", faces=6, solids=1)
def make_box() -> str:
    b = Brep()
    return b.text(box(b, (3, 2, 1)))


@good("instances", "a compound of three placed boxes: an elementary location, a product, an inverse power", faces=18, solids=3)
def instances() -> str:
    b = Brep()
    solid = box(b, (1, 1, 1))
    move = b.moved(4, 0, 0)
    turn = b.placement([(0, -1, 0, 0), (1, 0, 0, 0), (0, 0, 1, 0)])
    both = b.product((move, 1), (turn, 1))
    back = b.product((move, -1))
    return b.text(b.compound(use(solid, location=move), use(solid, location=both), use(solid, location=back)))


@good("unordered_wires", "a box whose wires list their edges out of order", faces=6, solids=1)
def unordered_wires() -> str:
    b = Brep()
    return b.text(box(b, (3, 2, 1), shuffled=True))


def cylinder(b: Brep, y_axis: tuple[float, float, float] = Y) -> int:
    """Radius 2, height 5; a left-handed placement where `y_axis` is -Y."""
    low, high = b.vertex((2, 0, 0)), b.vertex((2, 0, 5))
    left = y_axis != Y
    side = b.surface(2, O, Z, X, y_axis, 2)
    floor, roof = b.surface(1, O, Z, X, Y), b.surface(1, (0, 0, 5), Z, X, Y)

    def ring(vertex: int, z: float) -> int:
        # The circle runs with u of the side.
        axis = (0, 0, -1) if left else Z
        circle = b.curve(2, (0, 0, z), axis, X, y_axis, 2)
        on_side = b.pcurve(b.curve2(1, (0, z), (1, 0)), side, (0, TURN), (0, z, TURN, z))
        plane = floor if z == 0 else roof
        on_plane = b.pcurve(b.curve2(2, (0, 0), (1, 0), y_axis[:2], 2), plane, (0, TURN), (2, 0, 2, 0))
        return b.edge((vertex, vertex), circle, (0, TURN), on_side + on_plane)

    bottom, top = ring(low, 0), ring(high, 5)
    # The seam used forward is the side u = 2 pi.
    at_end, at_start = b.curve2(1, (TURN, 0), (0, 1)), b.curve2(1, (0, 0), (0, 1))
    seam = b.edge((low, high), b.curve(1, (2, 0, 0), Z), (0, 5), b.seam(at_end, at_start, side, (0, 5)))
    wall = b.face(side, b.wire(use(bottom), use(seam), use(top, "-"), use(seam, "-")))
    up, down = ("-", "+") if left else ("+", "-")
    lid = b.face(roof, b.wire(use(top, "-" if left else "+")))
    base = b.face(floor, b.wire(use(bottom, "-" if left else "+")))
    return b.solid(b.shell(use(wall, "-" if left else "+"), use(lid, "+"), use(base, "-")))


@good("cylinder_v2", "a seam with both its parameter curves, and the ends of parameter curves that version 2 has", faces=3, solids=1)
def cylinder_v2() -> str:
    b = Brep(version=2)
    return b.text(cylinder(b))


@good("left_handed", "a cylinder with a left-handed placement: its normal points inward, its face is reversed", faces=3, solids=1)
def left_handed() -> str:
    b = Brep()
    return b.text(cylinder(b, (0, -1, 0)))


@good("cone_v3", "a cone with its apex as a degenerated edge; v runs along the slant", faces=2, solids=1)
def cone_v3() -> str:
    b = Brep(version=3)
    angle = math.atan2(3, 4)
    apex, low = b.vertex((0, 0, 4)), b.vertex((3, 0, 0))
    # Radius 3 at v = 0, narrowing upwards: the half angle is negative.
    side = b.surface(3, O, Z, X, Y, 3, -angle)
    floor = b.surface(1, O, Z, X, Y)
    circle = b.curve(2, O, Z, X, Y, 3)
    bottom = b.edge((low, low), circle, (0, TURN), b.pcurve(b.curve2(1, (0, 0), (1, 0)), side, (0, TURN))
                    + b.pcurve(b.curve2(2, (0, 0), (1, 0), (0, 1), 3), floor, (0, TURN)))
    at_end, at_start = b.curve2(1, (TURN, 0), (0, 1)), b.curve2(1, (0, 0), (0, 1))
    seam = b.edge((low, apex), b.curve(1, (3, 0, 0), (-0.6, 0, 0.8)), (0, 5), b.seam(at_end, at_start, side, (0, 5)))
    point = b.edge((apex, apex), None, (0, TURN), b.pcurve(b.curve2(1, (0, 5), (1, 0)), side, (0, TURN)),
                   degenerated=True)
    wall = b.face(side, b.wire(use(bottom), use(seam), use(point, "-"), use(seam, "-")))
    base = b.face(floor, b.wire(use(bottom)))
    return b.text(b.solid(b.shell(use(wall), use(base, "-"))))


@good("periodic_prism", "a periodic B-spline extruded: knots that wrap round, a trimmed curve as profile", faces=3, solids=1)
def periodic_prism() -> str:
    b = Brep()
    count, degree, height = 7, 3, 2.0
    poles = [(math.cos(TURN * i / count) * (3 + i % 2), math.sin(TURN * i / count) * 3) for i in range(count)]
    knots = " ".join(f"{i} 1" for i in range(count + 1))

    def ring(z: float) -> str:
        return f"0 1 {degree} {count} {count + 1} " + numbers_of(poles, z) + " " + knots

    def start(z: float) -> tuple[float, float, float]:
        basis = (1 / 6, 4 / 6, 1 / 6)
        return (*(sum(w * p[a] for w, p in zip(basis, poles)) for a in range(2)), z)

    low, high = b.vertex(start(0)), b.vertex(start(height))
    side = b.surface(6, Z, tail=f"\n8 0 {count}\n7 {ring(0)}")
    floor, roof = b.surface(1, O, Z, X, Y), b.surface(1, (0, 0, height), Z, X, Y)
    rings = []
    for vertex, z in ((low, 0.0), (high, height)):
        on_side = b.pcurve(b.curve2(1, (0, z), (1, 0)), side, (0, count))
        rings.append(b.edge((vertex, vertex), b.curve(7, tail=ring(z)), (0, count), on_side))
    at_end, at_start = b.curve2(1, (count, 0), (0, 1)), b.curve2(1, (0, 0), (0, 1))
    seam = b.edge((low, high), b.curve(1, start(0), Z), (0, height), b.seam(at_end, at_start, side, (0, height)))
    bottom, top = rings
    wall = b.face(side, b.wire(use(bottom), use(seam), use(top, "-"), use(seam, "-")))
    lid, base = b.face(roof, b.wire(use(top))), b.face(floor, b.wire(use(bottom)))
    return b.text(b.solid(b.shell(use(wall), use(lid), use(base, "-"))))


def numbers_of(poles: list[tuple[float, float]], z: float) -> str:
    return " ".join(f"{x:.17g} {y:.17g} {z:.17g}" for x, y in poles)


@good("bezier_quarter", "a rational Bezier surface (a quarter of a cylinder) whose edges have only parameter curves", faces=1,
      closed=False)
def bezier_quarter() -> str:
    b = Brep()
    w = math.sqrt(0.5)
    rows = [((1, 0), 1), ((1, 1), w), ((0, 1), 1)]
    net = " ".join(f"{x} {y} {z} {weight:.17g}" for (x, y), weight in rows for z in (0, 2))
    surface = b.surface(8, tail=f"1 0 2 1 {net}")
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    at = {0: (1, 0), 1: (0, 1)}
    vertices = [b.vertex((*at[u], 2.0 * v)) for u, v in corners]
    uses = []
    for k in range(4):
        (u, v), (u2, v2) = corners[k], corners[(k + 1) % 4]
        line = b.curve2(1, (u, v), (u2 - u, v2 - v))
        uses.append(use(b.edge((vertices[k], vertices[(k + 1) % 4]), None, (0, 1), b.pcurve(line, surface, (0, 1)))))
    return b.text(b.shell(use(b.face(surface, b.wire(*uses))), closed=False))


@good("natural", "faces without wires: a whole sphere, and a rectangle of a torus", faces=2, closed=False)
def natural() -> str:
    b = Brep()
    sphere = b.face(b.surface(4, O, Z, X, Y, 2))
    tube = b.face(b.surface(10, (0, TURN / 4, 0, TURN / 2), tail="\n5 " + "9 0 0 0 0 1 1 0 0 0 1 0 3 1"))
    return b.text(b.compound(use(sphere), use(tube)))


@good("triangles_only", "a face with triangles and normals but no surface", faces=0, closed=False)
def triangles_only() -> str:
    b = Brep(version=3)
    mesh = b.triangulation([O, X, Y, Z], [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)], [Z, X, Y, Z])
    return b.text(b.shell(use(b.face(0, triangulation=mesh))))


@bad("truncated", "the file ends in the middle of the shapes; what came before is kept", exit="01", phrase="shapes are missing")
def truncated() -> str:
    b = Brep()
    text = b.text(box(b, (3, 2, 1)))
    return text[: text.rindex("\nSh\n") + 4]


@bad("binary", "the binary form", exit="2", phrase="binary form")
def binary() -> bytes:
    return b"\nOpen CASCADE Topology V4 (c)\nLocations\n\x00\x00\x00\x01\x02\xff"


@bad("version_9", "a version that does not exist", exit="2", phrase="version")
def version_9() -> str:
    b = Brep()
    return b.text(box(b, (1, 1, 1))).replace("Topology V1", "Topology V9")


@bad("nan", "a radius that is no number fails one face; the others stay", exit="1", phrase="radius")
def nan() -> str:
    b = Brep()
    text = b.text(cylinder(b))
    return text.replace("2 0 0 0 0 0 1 1 0 0 0 1 0 2\n1 0 0 0", "2 0 0 0 0 0 1 1 0 0 0 1 0 1.#QNAN\n1 0 0 0")


@bad("no_surfaces", "the section of the surfaces is missing", exit="1", phrase="surface")
def no_surfaces() -> str:
    b = Brep()
    text = b.text(box(b, (1, 1, 1)))
    return text[: text.index("\nSurfaces")] + text[text.index("\nTriangulations"):]


@bad("huge_counts", "counts that no file of this size can hold", exit="2", phrase="Curves breaks off")
def huge_counts() -> str:
    title = "CASCADE Topology V1, (c) Matra-Datavision\nLocations 0\nCurve2ds 0\n"
    return title + "Curves 2000000000\n7 0 0 3 2000000000 2 0 0 0\nSurfaces 0\nTriangulations 0\n\nTShapes 0\n\n"


@bad("compound_bomb", "compounds that hold each other twice, sixty deep", exit="01", phrase="too many references")
def compound_bomb() -> str:
    b = Brep()
    shape = box(b, (1, 1, 1))
    step = b.moved(1, 0, 0)
    for _ in range(60):
        shape = b.compound(use(shape), use(shape, location=step))
    return b.text(shape)


@bad("itself", "a shell that uses itself", exit="2", phrase="does not exist")
def itself() -> str:
    b = Brep()
    shell = b.shell(("+", 1, 0))
    return b.text(shell)


if __name__ == "__main__":
    write_all(corpus_folder(__doc__), "brep", ".brep", GOOD, BAD)
