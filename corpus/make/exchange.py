"""Small files of the exchange formats (JSON, OBJ, 3DM), good and broken, with an index of what is known about
them.

    python corpus/make/exchange.py

3DM files need `rhino3dm` and come out with new identifiers each time; they are only written where they are
missing.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from written import corpus_folder



@dataclass(frozen=True)
class File:
    """A file: its faces (of broken ones those that are saved), whether its mesh is closed, the right exit
    codes of `chordal mesh`, and a phrase that its message or report must hold."""

    name: str
    tests: str
    faces: int
    closed: bool
    exits: str
    phrase: str
    write: Callable[[Path], None]


FILES: list[File] = []


def file(name: str, tests: str, *, faces: int, closed: bool = False, exits: str = "0", phrase: str = ""):
    def register(write: Callable[[Path], None]) -> Callable[[Path], None]:
        FILES.append(File(name, tests, faces, closed, exits, phrase, write))
        return write

    return register


def text(path: Path, *lines: str) -> None:
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")


# --- OBJ

GRID = [f"v {x} {y} {round(math.sin(x * 1.3) * math.cos(y * 0.9), 6)}" for y in range(4) for x in range(4)]
ALL = "surf 0 1 0 1 " + " ".join(map(str, range(1, 17)))
UNIT = ["parm u 0 1", "parm v 0 1", "end"]


@file("obj_bezier.obj", "a bicubic Bézier patch, control points along u first", faces=1)
def obj_bezier(path: Path) -> None:
    text(path, *GRID, "cstype bezier", "deg 3 3", ALL, *UNIT)


@file("obj_bezier_patches.obj", "rational Bézier patches, two along u and three along v, in one element", faces=1)
def obj_bezier_patches(path: Path) -> None:
    points = [f"v {x} {y} {(x * y) % 3} {1 + (x + y) % 2}" for y in range(7) for x in range(5)]
    refs = " ".join(str(i - 35) for i in range(35))
    text(path, *points, "cstype rat bezier", "deg 2 2", f"surf 0 2 0 3 {refs}", "parm u 0 1 2", "parm v 0 1 2 3", "end")


@file("obj_cardinal.obj", "Cardinal splines interpolate all but the outer control points", faces=1)
def obj_cardinal(path: Path) -> None:
    text(path, *GRID, "cstype cardinal", "deg 3 3", ALL, *UNIT)


@file("obj_taylor.obj", "polynomial coefficients as control points", faces=1)
def obj_taylor(path: Path) -> None:
    rows = ["v 0 0 0", "v 2 0 0", "v 0 0 1", "v 0 3 0", "v 0 0 1", "v 0 0 0", "v 0 0 -1", "v 0 0 0", "v 0 0 0"]
    text(path, *rows, "cstype taylor", "deg 2 2", "surf 0 1 0 1 1 2 3 4 5 6 7 8 9", *UNIT)


@file("obj_bmatrix.obj", "the uniform cubic B-spline as a basis matrix, with a step of 1", faces=1)
def obj_bmatrix(path: Path) -> None:
    sixth = [1, -3, 3, -1, 4, 0, -6, 3, 1, 3, 3, -3, 0, 0, 0, 1]
    matrix = " ".join(repr(x / 6) for x in sixth)
    text(path, *GRID, "cstype bmatrix", "deg 3 3", "step 1 1", f"bmat u {matrix}", f"bmat v {matrix}", ALL, *UNIT)


TRIM = ["vp 0.3 0.3", "vp 0.7 0.3", "vp 0.7 0.7", "vp 0.3 0.7", "cstype bspline", "deg 1", "curv2 1 2 3 4 1",
        "parm u 0 0 1 2 3 4 4", "end"]


@file("obj_trim_and_hole.obj", "an outer loop of two pieces with a hole, given backwards", faces=1)
def obj_trim_and_hole(path: Path) -> None:
    outer = ["vp .5 .05", "vp .95 .05", "vp .95 .5", "vp .95 .95", "vp .5 .95", "vp .05 .95", "vp .05 .5",
             "vp .05 .05", "cstype bezier", "deg 2", "curv2 5 6 7 8 9", "parm u 0 1 2", "end", "curv2 9 10 11 12 5",
             "parm u 0 1 2", "end"]
    text(path, *GRID, *TRIM, *outer, "cstype bezier", "deg 3 3", ALL, "parm u 0 1", "parm v 0 1",
         "trim 0 2 2 0 2 3", "hole 4 0 1", "end")


@file("obj_hole_over_border.obj", "a hole that leaves the surface notches its border", faces=1)
def obj_hole_over_border(path: Path) -> None:
    moved = [line.replace("0.7", "1.7") for line in TRIM]
    text(path, *GRID, *moved, "cstype bezier", "deg 3 3", ALL, "parm u 0 1", "parm v 0 1", "hole 0 4 1", "end")


@file("obj_polygons.obj", "polygons pass through, concave ones as well", faces=0, closed=True)
def obj_polygons(path: Path) -> None:
    ring = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
    points = [f"v {x} {y} {z}" for z in (0, 1) for x, y in ring]
    sides = [f"f {i + 1} {(i + 1) % 6 + 1} {(i + 1) % 6 + 7} {i + 7}" for i in range(6)]
    text(path, "o bracket", *points, "f 6 5 4 3 2 1", "f 7 8 9 10 11 12", *sides)


@file("obj_continued.obj", "lines continued with a backslash, references counted backwards, comments", faces=1)
def obj_continued(path: Path) -> None:
    text(path, "# a patch", *GRID, "cstype bezier # rational? no", "deg 3 3", "surf 0 1 0 1 -16 -15 -14 -13 \\",
         "-12 -11 -10 -9 -8 -7 \\", "-6 -5 -4 -3 -2 -1", *UNIT)


@file("obj_call.obj", "other files are not read and commands are not run", faces=1, exits="1", phrase="which is not read")
def obj_call(path: Path) -> None:
    text(path, "call other.obj", "csh touch corpus-was-here", *GRID, "cstype bezier", "deg 3 3", ALL, *UNIT)


@file("obj_missing_vertex.obj", "one of two surfaces refers to a vertex that is not there", faces=2, exits="1", phrase="v 99 is not defined")
def obj_missing_vertex(path: Path) -> None:
    text(path, *GRID, "cstype bezier", "deg 3 3", ALL, *UNIT, ALL.replace(" 16", " 99"), *UNIT)


@file("obj_no_knots.obj", "a B-spline without knots", faces=1, exits="2", phrase="no knots")
def obj_no_knots(path: Path) -> None:
    text(path, *GRID, "cstype bspline", "deg 3 3", ALL, "end")


@file("obj_cut.obj", "the file truncated inside a surface", faces=1, phrase="truncated inside")
def obj_cut(path: Path) -> None:
    text(path, *GRID, "cstype bezier", "deg 3 3", ALL, "parm u 0 1", "parm v 0 1")


# --- JSON


def geomdl(*trims: dict) -> dict:
    surface = {
        "type": "spline", "rational": False, "dimension": 3, "degree_u": 3, "degree_v": 3,
        "knotvector_u": [0, 0, 0, 0, 1, 1, 1, 1], "knotvector_v": [0, 0, 0, 0, 1, 1, 1, 1], "size_u": 4, "size_v": 4,
        "control_points": {"points": [[i, j, round(math.sin(i + 2 * j), 6)] for i in range(4) for j in range(4)]},
        "delta": [0.05, 0.05],
    }
    if trims:
        surface["trims"] = {"count": len(trims), "data": list(trims)}
    return {"shape": {"type": "surface", "count": 1, "data": [surface]}}


def circle(u: float, v: float, r: float, *, reversed: int) -> dict:
    ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    return {
        "type": "spline", "rational": True, "dimension": 2, "degree": 2, "reversed": reversed, "delta": 0.01,
        "knotvector": [0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1],
        "control_points": {"points": [[u + r * x, v + r * y] for x, y in ring],
                           "weights": [1 if i % 2 == 0 else math.sqrt(0.5) for i in range(9)]},
    }


def dump(path: Path, data: object) -> None:
    path.write_text(json.dumps(data) + "\n", encoding="ascii", newline="\n")


@file("geomdl_hole.json", "a circular hole", faces=1)
def geomdl_hole(path: Path) -> None:
    dump(path, geomdl(circle(0.5, 0.5, 0.25, reversed=0)))


@file("geomdl_disc.json", "a reversed circle keeps its inside, and another one its own", faces=2)
def geomdl_disc(path: Path) -> None:
    dump(path, geomdl(circle(0.3, 0.3, 0.2, reversed=1), circle(0.7, 0.7, 0.2, reversed=1)))


@file("geomdl_over_border.json", "circles around a corner and a side of the domain", faces=1)
def geomdl_over_border(path: Path) -> None:
    dump(path, geomdl(circle(1.0, 1.0, 0.4, reversed=0), circle(0.0, 0.4, 0.3, reversed=0)))


@file("geomdl_nothing_left.json", "a hole around the whole domain", faces=1, exits="2", phrase="remove the whole surface")
def geomdl_nothing_left(path: Path) -> None:
    dump(path, geomdl(circle(0.5, 0.5, 2.0, reversed=0)))


@file("geomdl_bad_knots.json", "one of two surfaces has knots that decrease", faces=2, exits="1", phrase="knot 4 decreases")
def geomdl_bad_knots(path: Path) -> None:
    data, other = geomdl(), geomdl()
    other["shape"]["data"][0]["knotvector_u"][3:5] = [2, 1]
    data["shape"]["data"] += other["shape"]["data"]
    dump(path, data)


@file("json_unknown.json", "JSON of another kind", faces=0, exits="2", phrase="neither")
def json_unknown(path: Path) -> None:
    dump(path, {"asset": {"version": "2.0"}})


@file("json_cut.json", "cut off in the middle", faces=0, exits="2", phrase="EOF")
def json_cut(path: Path) -> None:
    dump(path, geomdl())
    path.write_bytes(path.read_bytes()[:500])


def world(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> dict:
    return {"origin": [x, y, z], "x": [1, 0, 0], "z": [0, 0, 1]}


def model(part: dict) -> dict:
    node = {"name": "part", "transform": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]], "part": 0}
    return {"schema": "chordal-model/1", "name": "part", "unit": "mm", "parts": [part], "nodes": [node], "roots": [0]}


def cylinder() -> dict:
    """Radius 2, height 5, without a seam: two circles."""
    rim = lambda z, edge, forward: {"edges": {"outer": True, "coedges": [{"edge": edge, "forward": forward}]}}
    edge = lambda z, v: {"curve": {"circle": {"frame": world(z=z), "radius": 2}}, "range": [0, math.tau],
                         "start": v, "end": v}
    return {
        "surfaces": [{"cylinder": {"frame": world(), "radius": 2}}, {"plane": {"frame": world()}},
                     {"plane": {"frame": world(z=5)}}],
        "vertices": [{"point": [2, 0, 0]}, {"point": [2, 0, 5]}],
        "edges": [edge(0, 0), edge(5, 1)],
        "faces": [{"surface": 0, "loops": [rim(0, 0, True), rim(5, 1, False)]},
                  {"surface": 1, "same_sense": False, "loops": [rim(0, 0, False)]},
                  {"surface": 2, "loops": [rim(5, 1, True)]}],
        "shells": [{"faces": [0, 1, 2], "closed": True}],
        "bodies": [{"kind": "solid", "shells": [0]}],
    }


@file("model_cylinder.json", "our own document, written by hand", faces=3, closed=True)
def model_cylinder(path: Path) -> None:
    dump(path, model(cylinder()))


@file("model_bad_edge.json", "a face refers to an edge that is not there", faces=3, exits="1", phrase="edge 7 does not exist")
def model_bad_edge(path: Path) -> None:
    part = cylinder()
    part["faces"][2]["loops"][0]["edges"]["coedges"][0]["edge"] = 7
    dump(path, model(part))


@file("model_of_tomorrow.json", "a later version of our own document", faces=0, exits="2", phrase="chordal-model/2")
def model_of_tomorrow(path: Path) -> None:
    dump(path, {**model(cylinder()), "schema": "chordal-model/2"})


@file("model_circle.json", "a tree that is none", faces=0, exits="2", phrase="used twice")
def model_circle(path: Path) -> None:
    data = model(cylinder())
    data["nodes"][0]["children"] = [0]
    dump(path, data)


# --- 3DM


def blocks(r, archive) -> None:
    """A block with a box, one with a sphere and that block in it, placed in the file as it is, moved, mirrored."""
    point, plain = r.Point3d, r.ObjectAttributes()
    box = lambda low, high: r.Brep.CreateFromBoundingBox(r.BoundingBox(point(*low), point(*high)))
    define = lambda name, *shapes: archive.InstanceDefinitions.Add(
        name, "", "", "", point(0, 0, 0), shapes, tuple(plain for _ in shapes)
    )
    place = lambda block, transform: r.InstanceReference(archive.InstanceDefinitions[block].Id, transform)
    define("bolt", box((0, 0, 0), (2, 1, 1)))
    sphere = r.Brep.CreateFromSphere(r.Sphere(point(0, 0, 4), 1))
    define("pair", sphere, place(0, r.Transform.Translation(5, 0, 0)))
    mirror = r.Transform.Mirror(r.Plane(point(0, -10, 0), r.Vector3d(0, 1, 0)))
    turn = r.Transform.Rotation(math.pi / 2, r.Vector3d(0, 0, 1), point(0, 0, 0))
    for block, transform in ((0, turn), (1, r.Transform.Translation(0, 20, 0)), (1, mirror)):
        archive.Objects.AddInstanceObject(place(block, transform))
    archive.Objects.AddBrep(box((-9, -9, -9), (-8, -8, -8)))


def rhino(fill: Callable, version: int, path: Path) -> None:
    if path.exists():
        return
    import rhino3dm

    archive = rhino3dm.File3dm()
    archive.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Centimeters
    fill(rhino3dm, archive if fill is blocks else archive.Objects)
    archive.Write(str(path), version)


def solids(r, objects) -> None:
    point = r.Point3d
    objects.AddBrep(r.Brep.CreateFromSphere(r.Sphere(point(0, 0, 0), 3)))
    objects.AddBrep(r.Brep.CreateFromCylinder(r.Cylinder(r.Circle(point(10, 0, 0), 2), 5), True, True))
    objects.AddBrep(r.Brep.CreateFromBoundingBox(r.BoundingBox(point(-10, -1, -1), point(-6, 1, 2))))


def revolutions(r, objects) -> None:
    point, pi = r.Point3d, math.pi
    cone = r.RevSurface.Create(r.LineCurve(point(2, 0, 0), point(3, 0, 5)), r.Line(point(0, 0, 0), point(0, 0, 1)), 0.5, 2.0)
    objects.AddBrep(r.Brep.CreateFromRevSurface(cone, False, False))
    arc = r.Arc(point(15, 0, -2), point(17, 0, 0), point(15, 0, 2)).ToNurbsCurve()
    drum = r.RevSurface.Create(arc, r.Line(point(12, 0, 0), point(12, 0, 1)), 0.0, 2 * pi)
    objects.AddBrep(r.Brep.CreateFromRevSurface(drum, True, True))


def extrusions(r, objects) -> None:
    point = r.Point3d
    corners = lambda *xy: r.Polyline([point(x, y, 0) for x, y in xy]).ToPolylineCurve()
    objects.AddExtrusion(r.Extrusion.CreateBoxExtrusion(r.Box(r.BoundingBox(point(0, 0, 0), point(4, 2, 1))), True))
    objects.AddExtrusion(r.Extrusion.CreatePipeExtrusion(r.Cylinder(r.Circle(point(10, 0, 0), 3), 5), 2.0, True, True))
    bracket = corners((20, 0), (24, 0), (24, 2), (22, 2), (22, 5), (20, 5), (20, 0))
    objects.AddExtrusion(r.Extrusion.Create(bracket, -3.0, True))


def mesh(r, objects) -> None:
    pyramid = r.Mesh()
    for corner in [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)]:
        pyramid.Vertices.Add(*corner)
    pyramid.Faces.AddFace(3, 2, 1, 0)
    for a, b in [(0, 1), (1, 2), (2, 3), (3, 0)]:
        pyramid.Faces.AddFace(a, b, 4)
    objects.AddMesh(pyramid)


@file("rhino_solids_2.3dm", "sphere, cylinder and box in an archive of version 2", faces=10, closed=True)
def rhino_solids_2(path: Path) -> None:
    rhino(solids, 2, path)


@file("rhino_solids_4.3dm", "the same in version 4", faces=10, closed=True)
def rhino_solids_4(path: Path) -> None:
    rhino(solids, 4, path)


@file("rhino_solids_8.3dm", "the same in version 8", faces=10, closed=True)
def rhino_solids_8(path: Path) -> None:
    rhino(solids, 8, path)


@file("rhino_revolutions.3dm", "surfaces of revolution that begin at an angle, and about an arc", faces=4)
def rhino_revolutions(path: Path) -> None:
    rhino(revolutions, 7, path)


@file("rhino_extrusions.3dm", "light extrusions: a box, a pipe, and one that goes down", faces=18, closed=True)
def rhino_extrusions(path: Path) -> None:
    rhino(extrusions, 5, path)


@file("rhino_mesh_5.3dm", "a mesh in compressed buffers", faces=0, closed=True)
def rhino_mesh_5(path: Path) -> None:
    rhino(mesh, 5, path)


@file("rhino_blocks_5.3dm", "blocks, one within another, placed, moved and mirrored, in version 5", faces=26, closed=True)
def rhino_blocks_5(path: Path) -> None:
    rhino(blocks, 5, path)


@file("rhino_blocks_8.3dm", "the same in version 8", faces=26, closed=True)
def rhino_blocks_8(path: Path) -> None:
    rhino(blocks, 8, path)


@file("rhino_cut.3dm", "cut off in the middle of the second object", faces=1, exits="1", phrase="damaged")
def rhino_cut(path: Path) -> None:
    whole = (Path(__file__).resolve().parent.parent / "exchange" / "rhino_solids_8.3dm").read_bytes()
    first = whole.index(struct.pack("<I", 0x20008070))
    second = whole.index(struct.pack("<I", 0x20008070), first + 4)
    path.write_bytes(whole[: second + 1000])


@file("rhino_head.3dm", "a head and nothing else", faces=0, exits="2", phrase="no shape")
def rhino_head(path: Path) -> None:
    path.write_bytes(b"3D Geometry File Format        5")


def main() -> None:
    folder = corpus_folder(__doc__) / "exchange"
    folder.mkdir(exist_ok=True)
    rows = ["file\ttests\tfaces\tclosed\texits\tphrase"]
    for f in FILES:
        f.write(folder / f.name)
        rows.append("\t".join([f.name, f.tests, str(f.faces), "yes" if f.closed else "no", f.exits, f.phrase]))
    (folder / "INDEX.tsv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    size = sum(path.stat().st_size for path in folder.iterdir())
    print(f"{len(FILES)} files, {size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
