"""The IGES files of the corpus, and broken ones: one function each.

    python corpus/make/iges_files.py        # writes corpus/iges and corpus/iges/bad with their INDEX.tsv
"""

from __future__ import annotations

import math

from iges_text import Iges
from written import BAD, GOOD, bad, corpus_folder, good, write_all

UV = "00010500"
SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


def plate(g: Iges, hole: bool = True, **more) -> int:
    """A trimmed square of 10 by 10 at height 2, with a round hole in both descriptions."""
    s = g.bilinear((0.0, 0.0, 2.0), (10.0, 0.0, 2.0), (0.0, 10.0, 2.0), (10.0, 10.0, 2.0), status="00010000")
    outer = g.boundary(s, g.chain(SQUARE, UV), g.chain([(10 * x, 10 * y, 2.0) for x, y in SQUARE]))
    if not hole:
        return g.trimmed(s, outer, **more)
    inner = g.boundary(s, g.circle((0.5, 0.5), 0.2, status=UV), g.circle((5.0, 5.0), 2.0, 2.0))
    return g.trimmed(s, outer, inner, **more)


@good("plate", "a trimmed surface (144) with a hole: curves in space and in parameters", faces=1, closed=False)
def make_plate() -> str:
    g = Iges()
    plate(g)
    return g.text()


@good("layout", "other delimiters, parameters up to column 64 with the delimiter behind it, CRLF, cut blanks", faces=1,
      closed=False)
def layout() -> str:
    g = Iges(delimiters="/#")
    plate(g)
    lines = []
    for line in g.text(width=65).split("\n"):
        if len(line) > 72 and line[72] == "P" and len(line[:64].rstrip()) < 64:
            line = line[:64] + " " + line[65:]
        lines.append(line.rstrip())
    return "\r\n".join(lines)


def box_lists(g: Iges, size: tuple[float, float, float]) -> tuple[int, dict, list]:
    """Vertex list, edges as (position, direction) by pairs of corners, and the edge list's number."""
    corners = [tuple(size[a] * (i >> a & 1) for a in range(3)) for i in range(8)]
    vertices = g.add(502, 8, corners, form=1, status="00010000")
    rows, position = [], {}
    for i in range(8):
        for a in range(3):
            j = i | 1 << a
            if j != i:
                rows.append((g.line(corners[i], corners[j]), vertices, i + 1, vertices, j + 1))
                position[i, j] = len(rows)
    edges = g.add(504, len(rows), rows, form=1, status="00010000")
    return edges, position, corners


@good("box_solid", "a manifold solid (186) with planes (190): shared edges, faces used with and against their senses", faces=6,
      solids=1)
def box_solid() -> str:
    g = Iges(product="box")
    size = (3.0, 2.0, 1.0)
    edges, position, _ = box_lists(g, size)
    faces = []
    for a in range(3):
        u, v = 1 << (a + 1) % 3, 1 << (a + 2) % 3
        direction = g.add(123, tuple(float(k == a) for k in range(3)), status="00010200")
        for top in (0, 1):
            base = (1 << a) * top
            ring = [base, base | u, base | u | v, base | v]
            uses = []
            for k in range(4):
                i, j = ring[k], ring[(k + 1) % 4]
                uses.append((0, edges, position[min(i, j), max(i, j)], int(i < j), 0))
            loop = g.add(508, 4, uses, form=1, status="00010000")
            point = g.add(116, tuple(size[k] * top * (k == a) for k in range(3)), 0, status="00010400")
            plane = g.add(190, point, direction, status="00010000")
            faces.append((g.add(510, plane, 1, 1, loop, form=1, status="00010000"), top))
    shell = g.add(514, 6, faces, form=1, status="00010000")
    g.add(186, shell, 1, 0)
    return g.text()


@good("cylinder_solid", "a manifold solid with a cylinder (192) whose seam is one edge used twice", faces=3, solids=1)
def cylinder_solid() -> str:
    g = Iges()
    vertices = g.add(502, 2, (2.0, 0.0, 0.0), (2.0, 0.0, 5.0), form=1, status="00010000")
    rows = [(g.circle((0.0, 0.0), 2.0, 0.0), vertices, 1, vertices, 1),
            (g.circle((0.0, 0.0), 2.0, 5.0), vertices, 2, vertices, 2),
            (g.line((2.0, 0.0, 0.0), (2.0, 0.0, 5.0)), vertices, 1, vertices, 2)]
    edges = g.add(504, 3, rows, form=1, status="00010000")
    up = g.add(123, 0.0, 0.0, 1.0, status="00010200")
    points = [g.add(116, 0.0, 0.0, z, 0, status="00010400") for z in (0.0, 5.0)]
    wall = g.add(508, 4, (0, edges, 1, 1, 0), (0, edges, 3, 1, 0), (0, edges, 2, 0, 0), (0, edges, 3, 0, 0), form=1)
    faces = [(g.add(510, g.add(192, points[0], up, 2.0), 1, 1, wall, form=1), 1)]
    for k, z in enumerate((0, 1)):
        loop = g.add(508, 1, 0, edges, k + 1, 1, 0, form=1)
        faces.append((g.add(510, g.add(190, points[k], up), 1, 1, loop, form=1), z))
    g.add(186, g.add(514, 3, faces, form=1), 1, 0)
    return g.text()


@good("untrimmed", "surfaces that are faces by themselves: 128 (with a smaller range), 114, 118, 120, 122, 140, 196, 198", faces=8,
      closed=False)
def untrimmed() -> str:
    g = Iges()
    g.bilinear((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (4.0, 4.0, 2.0), (0.25, 1.0, 0.0, 0.5))
    # x = s, y = t, z = s t over one unit square; the row and the column beyond it mean nothing.
    x, y, z = [0.0] * 16, [0.0] * 16, [0.0] * 16
    x[1] = y[4] = z[5] = 1.0
    g.add(114, 3, 1, 1, 1, 0.0, 1.0, 0.0, 1.0, x, y, z, [0.0] * 48, [0.0] * 48, [0.0] * 48)
    rail = g.add(126, 2, 2, 0, 0, 1, 0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, (0.0, 6.0, 0.0), (1.0, 6.0, 2.0),
                 (2.0, 6.0, 0.0), 0.0, 1.0, 0.0, 0.0, 1.0, status="00010000")
    g.add(118, rail, g.line((0.0, 8.0, 0.0), (2.0, 8.0, 0.0)), 0, 0, form=1)
    axis = g.line((10.0, 0.0, 0.0), (10.0, 0.0, 1.0))
    arc = g.add(126, 2, 2, 0, 0, 0, 0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.8, 1.0, (11.0, 0.0, 0.0), (12.0, 0.0, 1.0),
                (11.0, 0.0, 2.0), 0.0, 1.0, 0.0, 1.0, 0.0, status="00010000")
    g.add(120, axis, arc, 0.0, 1.5 * math.pi)
    g.add(122, g.circle((20.0, 0.0), 1.0), 21.0, 0.0, 3.0)
    basis = g.bilinear((0.0, 20.0, 0.0), (4.0, 20.0, 0.0), (0.0, 24.0, 0.0), (4.0, 24.0, 2.0), status="00010000")
    g.add(140, 0.0, 0.0, -1.0, 0.5, basis)
    center, up = g.add(116, 30.0, 0.0, 0.0, 0, status="00010400"), g.add(123, 0.0, 0.0, 1.0, status="00010200")
    g.add(196, center, 2.0)
    g.add(198, center, up, 5.0, 1.0)
    return g.text()


@good("half_sphere", "a surface of revolution (120) whose arc ends on the axis; the boundary in parameters runs along the pole", faces=1,
      closed=False)
def half_sphere() -> str:
    g = Iges()
    axis = g.line((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    arc = g.add(100, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, -3.0, status="00010000")
    s = g.add(120, axis, arc, 0.0, 2 * math.pi, status="00010000")
    q, h = 0.5 * math.pi, math.pi
    # From the pole to the equator, half round it, back, and along the pole.
    parameters = g.chain([(q, 0.0), (h, 0.0), (h, h), (q, h)], UV)
    # Angle 0 is the half plane of the arc itself, on the side of -x.
    down = g.add(100, 0.0, 0.0, 0.0, 0.0, 3.0, -3.0, 0.0, status="00010000")
    tilted = g.add(124, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, status="00010000")
    around = g.add(100, 0.0, 0.0, 0.0, -3.0, 0.0, 3.0, 0.0, status="00010000", matrix=tilted)
    up = g.add(100, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 3.0, status="00010000")
    g.trimmed(s, g.boundary(s, parameters, g.add(102, 3, down, around, up, status="00010000"), 1))
    return g.text()


@good("sphere_turned", "a quarter of a sphere whose boundary in parameters is that of another quarter", faces=1, closed=False)
def sphere_turned() -> str:
    g = Iges()
    axis = g.line((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    arc = g.add(100, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0, -3.0, status="00010000")
    s = g.add(120, axis, arc, 0.0, 2 * math.pi, status="00010000")
    q, h = 0.5 * math.pi, math.pi
    parameters = g.chain([(q, 0.0), (h, 0.0), (h, h), (q, h)], UV)
    # In space it is turned by half a turn about z.
    down = g.add(100, 0.0, 0.0, 0.0, 0.0, -3.0, 3.0, 0.0, status="00010000")
    tilted = g.add(124, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, status="00010000")
    around = g.add(100, 0.0, 0.0, 0.0, 3.0, 0.0, -3.0, 0.0, status="00010000", matrix=tilted)
    up = g.add(100, 0.0, 0.0, 0.0, -3.0, 0.0, 0.0, -3.0, status="00010000")
    g.trimmed(s, g.boundary(s, parameters, g.add(102, 3, down, around, up, status="00010000"), 1))
    return g.text()


@good("parameters_only", "a tabulated cylinder (122) trimmed in its parameters 0..1 alone", faces=1, closed=False)
def parameters_only() -> str:
    g = Iges()
    s = g.add(122, g.circle((0.0, 0.0), 2.0), 2.0, 0.0, 5.0, status="00010000")
    g.trimmed(s, g.boundary(s, g.chain([(0.25, 0.2), (0.75, 0.2), (0.75, 0.8), (0.25, 0.8)], UV), 0, 1))
    return g.text()


@good("model_elsewhere", "the curves in space repeat those in parameters and lie far off the surface", faces=1, closed=False)
def model_elsewhere() -> str:
    g = Iges()
    s = g.bilinear((0.0, 0.0, 9.0), (10.0, 0.0, 9.0), (0.0, 10.0, 9.0), (10.0, 10.0, 12.0), status="00010000")
    g.trimmed(s, g.boundary(s, g.chain(SQUARE, UV), g.chain(SQUARE), 1))
    return g.text()


@good("bounded", "a bounded surface (143) whose boundary (141) has curves that are to be run backwards", faces=1, closed=False)
def bounded() -> str:
    g = Iges()
    s = g.bilinear((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (4.0, 4.0, 2.0), status="00010000")
    corner = {(0, 0): (0.0, 0.0, 0.0), (1, 0): (4.0, 0.0, 0.0), (1, 1): (4.0, 4.0, 2.0), (0, 1): (0.0, 4.0, 0.0)}
    rows = []
    for k, (a, b) in enumerate([((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0))]):
        sense = 1 if k % 2 == 0 else 2
        ends = (corner[a], corner[b]) if sense == 1 else (corner[b], corner[a])
        flat = g.line(tuple(map(float, a)), tuple(map(float, b)), UV)
        rows.append((g.line(*ends), sense, 1, flat))
    g.add(143, 1, s, 1, g.add(141, 1, 0, s, 4, rows, status="00010000"))
    return g.text()


@good("plane_conic", "a plane (108) bounded by an ellipse (104), turned by a matrix; a line and a point that belong to nothing",
      faces=1, closed=False)
def plane_conic() -> str:
    g = Iges()
    ellipse = g.add(104, 4.0, 0.0, 9.0, 0.0, 0.0, -36.0, 0.0, 3.0, 0.0, 3.0, 0.0, form=1, status="00010000")
    turn = g.add(124, 0.0, 0.0, 1.0, 5.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, status="00010000")
    g.add(108, 0.0, 0.0, 1.0, 0.0, ellipse, 0.0, 0.0, 0.0, 0.0, form=1, matrix=turn)
    g.add(110, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0)
    g.add(116, 1.0, 2.0, 3.0, 0)
    return g.text()


@good("subfigures", "a subfigure (308) placed three times (408): moved, scaled, and within another one that is turned", faces=3,
      closed=False)
def subfigures() -> str:
    g = Iges(unit=(1, "IN"))
    figure = g.add(308, 0, "plate", 1, plate(g, hole=False, status="00010000"), status="00000200")
    g.add(408, figure, 0.0, 0.0, 0.0, 1.0)
    g.add(408, figure, 20.0, 0.0, 0.0, 2.0)
    turn = g.add(124, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, status="00010000")
    inner = g.add(408, figure, 0.0, 50.0, 0.0, 1.0, status="00010000")
    pair = g.add(308, 1, "turned", 1, inner, status="00000200")
    g.add(408, pair, 0.0, 0.0, 0.0, 1.0, matrix=turn)
    return g.text()


@good("looks", "a group (402) with a name (406), a colour of its own (314), numbered colours, levels, labels", faces=2, closed=False)
def looks() -> str:
    g = Iges()
    orange = g.add(314, 100.0, 50.0, 0.0, "orange", status="00000200")
    first = plate(g, color=-orange, level=7, label="FIRST")
    second = plate(g, color=3)
    name = g.add(406, 1, "two plates", form=15, status="00010000")
    g.add(402, 2, first, second, 0, 1, name, form=7)
    return g.text()


@bad("three_sides", "an outer boundary in space that leaves out one side of its patch and cuts its corners", exit="0",
     phrase="runs along the border of the surface")
def three_sides() -> str:
    g = Iges()
    s = g.bilinear((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, 10.0, 0.0), (10.0, 10.0, 2.0), status="00010000")
    path = [(10.0, 0.0, 0.0), (10.0, 9.9, 1.98), (9.9, 10.0, 1.98), (0.1, 10.0, 0.02), (0.0, 9.9, 0.0), (0.0, 0.0, 0.0)]
    lines = [g.line(a, b) for a, b in zip(path, path[1:])]
    g.trimmed(s, g.boundary(s, 0, g.add(102, len(lines), *lines, status="00010000"), 2))
    return g.text()


@bad("wrong_counts", "strings of the global section and of a name whose counts reach into the next fields", exit="0",
     phrase="counts 17 characters and has 11")
def wrong_counts() -> str:
    return looks().replace("11Hby hand.igs", "17Hby hand.igs").replace("10Htwo plates", "14Htwo plates")


@bad("compressed", "the compressed form", exit="2", phrase="compressed")
def compressed() -> str:
    return f"{'':<72}C{1:>7}\n" + make_plate()


@bad("binary", "the binary form", exit="2", phrase="binary form")
def binary() -> bytes:
    return b"B\x00\x00\x00\x30\x00\x20\x08\x17\x0f\x34\x08" + bytes(80)


@bad("truncated", "the file ends in the middle of the parameters", exit="01", phrase="is missing")
def truncated() -> str:
    text = make_plate()
    return text[: int(len(text) * 0.9)]


@bad("missing_surface", "a trimmed surface refers to an entity that is not there", exit="012", phrase="does not exist")
def missing_surface() -> str:
    g = Iges()
    plate(g)
    g.add(144, 999, 1, 0, 1)
    return g.text()


@bad("wrong_parameters", "a directory entry points to the parameters of another entity", exit="012", phrase="the parameter record of")
def wrong_parameters() -> str:
    text = make_plate()
    return text.replace(f"{128:>8}{1:>8}", f"{128:>8}{6:>8}", 1)


@bad("nan", "a coordinate that is no number", exit="012", phrase="expected a number")
def nan() -> str:
    return make_plate().replace("10.0,0.0,2.0,", "NaN0,0.0,2.0,", 1)


@bad("cyclic_curve", "a composite curve that holds itself", exit="012", phrase="is recursive or nested")
def cyclic_curve() -> str:
    g = Iges()
    s = g.bilinear((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (4.0, 4.0, 2.0), status="00010000")
    loop = g.add(102, 1, 3)
    g.trimmed(s, g.boundary(s, 0, loop))
    return g.text()


@bad("huge_counts", "counts that no file of this size can hold", exit="012", phrase="needed")
def huge_counts() -> str:
    g = Iges()
    g.add(128, 2000000, 2000000, 3, 3, 0, 0, 1, 0, 0, 0.0, 0.0)
    return g.text()


@bad("instance_bomb", "subfigures that hold each other twice, thirty deep", exit="01", phrase="nodes; the rest is ignored")
def instance_bomb() -> str:
    g = Iges()
    figure = g.add(308, 0, "plate", 1, plate(g, hole=False, status="00010000"), status="00000200")
    for depth in range(30):
        uses = [g.add(408, figure, float(k), 0.0, 0.0, 1.0, status="00010000") for k in range(2)]
        figure = g.add(308, depth, "two", 2, uses, status="00000200")
    g.add(408, figure, 0.0, 0.0, 0.0, 1.0)
    return g.text()


@bad("open_boundary", "the boundary lacks one of its sides", exit="01", phrase="closed along the surface")
def open_boundary() -> str:
    g = Iges()
    s = g.bilinear((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (4.0, 4.0, 0.0), status="00010000")
    corners = [(4 * x, 4 * y, 0.0) for x, y in SQUARE]
    sides = [g.line(corners[i], corners[i + 1]) for i in range(3)]
    g.trimmed(s, g.boundary(s, 0, g.add(102, 3, sides, status="00010000")))
    return g.text()


@bad("turned_curve", "one curve of a boundary runs against the others", exit="01", phrase="reversed")
def turned_curve() -> str:
    g = Iges()
    s = g.bilinear((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0), (4.0, 4.0, 0.0), status="00010000")
    corners = [(4 * x, 4 * y, 0.0) for x, y in SQUARE]
    sides = [g.line(corners[i], corners[(i + 1) % 4]) if i != 2 else g.line(corners[3], corners[2]) for i in range(4)]
    g.trimmed(s, g.boundary(s, 0, g.add(102, 4, sides, status="00010000")))
    return g.text()


@bad("not_a_solid", "a solid of constructive geometry (block, 150), which is no boundary representation", exit="012",
     phrase="is not supported")
def not_a_solid() -> str:
    g = Iges()
    plate(g)
    g.add(150, 1.0, 2.0, 3.0, 0.0, 0.0, 0.0)
    return g.text()


if __name__ == "__main__":
    write_all(corpus_folder(__doc__), "iges", ".igs", GOOD, BAD)
