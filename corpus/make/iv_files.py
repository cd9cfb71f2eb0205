"""The Inventor files of the corpus, and broken ones: one function each.

    python corpus/make/iv_files.py        # writes corpus/iv and corpus/iv/bad with their INDEX.tsv
"""

from __future__ import annotations

import math
import struct

import iv_pictures  # noqa: F401  (registers its files)
from scene_large import scene
from written import BAD, GOOD, bad, corpus_folder, good, write_all

HEADER = "#Inventor V2.1 ascii\n\n"
W = math.sqrt(0.5)
KNOTS = "[ 0 0 0 1 1 1 ]"
RING = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
RING_KNOTS = "[ 0 0 0 1 1 2 2 3 3 4 4 4 ]"
WEIGHTS = [1 if i % 2 == 0 else W for i in range(9)]


def numbers(points: list[tuple[float, ...]]) -> str:
    return ",\n    ".join(" ".join(f"{x:.9g}" for x in p) for p in points)


def hill() -> list[tuple[float, float, float]]:
    return [(i, j, 1.0 if i == j == 1 else 0.0) for j in range(3) for i in range(3)]


def coordinates(points: list[tuple[float, ...]], size: int = 3) -> str:
    return f"  Coordinate{size} {{ point [\n    {numbers(points)} ] }}\n"


SURFACE = f"  NurbsSurface {{ numUControlPoints 3 numVControlPoints 3 uKnotVector {KNOTS} vKnotVector {KNOTS} }}\n"


def group(*parts: str) -> str:
    return "Separator {\n" + "".join(parts) + "}\n"


@good("patch", "one biquadratic patch", faces=1, closed=False)
def patch() -> str:
    return HEADER + group(coordinates(hill()), SURFACE)


@good("trimmed", "an outer line, a rational circle as a hole, and a loop of a line and a spline", faces=1, closed=False)
def trimmed() -> str:
    corners = [(0.05, 0.05), (0.95, 0.05), (0.95, 0.95), (0.05, 0.95)]
    circle = [((0.3 + 0.15 * x) * w, (0.5 + 0.15 * y) * w, w) for (x, y), w in zip(RING, WEIGHTS)]
    return HEADER + group(
        coordinates(hill()),
        f"  ProfileCoordinate2 {{ point [ {numbers(corners)} ] }}\n  LinearProfile {{ index [ 0 1 2 3 0 ] }}\n",
        f"  ProfileCoordinate3 {{ point [ {numbers(circle)} ] }}\n",
        f"  NurbsProfile {{ index [ 0 1 2 3 4 5 6 7 8 ] linkage START_NEW knotVector {RING_KNOTS} }}\n",
        "  ProfileCoordinate2 { point [ 0.6 0.3, 0.85 0.3, 0.85 0.7, 0.6 0.7 ] }\n",
        "  LinearProfile { index [ 0 1 ] linkage START_NEW }\n",
        "  NurbsProfile { index [ 1 2 3 0 ] linkage ADD_TO_CURRENT knotVector [ 0 0 0 0 1 1 1 1 ] }\n",
        SURFACE,
    )


def tube() -> list[tuple[float, float, float, float]]:
    return [(x * w, y * w, z * w, w) for z in (0.0, 2.0) for (x, y), w in zip(RING, WEIGHTS)]


def tube_surface() -> str:
    index = " ".join(map(str, range(18)))
    return (
        f"  IndexedNurbsSurface {{ numUControlPoints 9 numVControlPoints 2 coordIndex [ {index} ]\n"
        f"    uKnotVector {RING_KNOTS} vKnotVector [ 0 0 1 1 ] }}\n"
    )


@good("closed_tube", "a rational cylinder that closes along u: two loops round it, its seam none", faces=1, closed=False)
def closed_tube() -> str:
    return HEADER + group(coordinates(tube(), 4), tube_surface())


@good("tube_rectangle", "a closed cylinder trimmed by the rectangle of its whole domain", faces=1, closed=False)
def tube_rectangle() -> str:
    trim = "  ProfileCoordinate2 { point [ 0 0, 4 0, 4 1, 0 1 ] }\n  LinearProfile { index [ 0 1 2 3 0 ] }\n"
    return HEADER + group(coordinates(tube(), 4), trim, tube_surface())


@good("collapsed", "a patch one of whose sides is a point", faces=1, closed=False)
def collapsed() -> str:
    points = [(i * j / 2, j, 0.5 * (j == 1)) for j in range(3) for i in range(3)]
    return HEADER + group(coordinates(points), SURFACE)


@good("instances", "a separator used three times, once mirrored, in inches", faces=3, closed=False)
def instances() -> str:
    return HEADER + group(
        "Units { units INCHES }\n",
        "DEF Wing " + group("Material { diffuseColor 0.8 0.1 0.1 }\n", coordinates(hill()), SURFACE),
        "Translation { translation 4 0 0 }\nUSE Wing\n",
        "Scale { scaleFactor -1 1 1 }\nRotationXYZ { axis X angle 0.5 }\nUSE Wing\n",
    )


@good("solids", "a cube, a sphere, a cylinder and a cone", faces=12, solids=4)
def solids() -> str:
    step = "Translation { translation 3 0 0 }\n"
    return HEADER + group("Cube { depth 1 }\n", step, "Sphere { }\n", step, "Cylinder { }\n", step, "Cone { }\n")


@good("polygons", "polygons of four kinds and no surface", faces=0, closed=False)
def polygons() -> str:
    return HEADER + group(
        "Coordinate3 { point [ 0 0 0, 2 0 0, 2 2 0, 1 0.5 0, 0 2 0 ] }\n",
        "IndexedFaceSet { coordIndex [ 0 1 2 3 4 -1 ] }\n",
        "ShapeHints { vertexOrdering CLOCKWISE }\nFaceSet { numVertices [ 3 ] }\n",
        "TriangleStripSet { numVertices [ 4 ] }\nQuadMesh { verticesPerRow 2 verticesPerColumn 2 }\n",
    )


@good("vrml_1", "VRML 1.0, a part of Inventor", faces=3, solids=1)
def vrml_1() -> str:
    return "#VRML V1.0 ascii\n\n" + group("Translation { translation 0 1 0 }\n", "Cylinder { parts ALL }\n")


@good("large_60", "sixty surfaces of the scene for the bench of sewing", faces=60, closed=False)
def large_60() -> str:
    text, _ = scene(60, 2e-5)
    return text


class Binary:
    """The binary encoding: words of four bytes, the highest first."""

    def __init__(self, header: bytes = b"#Inventor V2.1 binary  \n") -> None:
        self.data = header

    def word(self, *words: int) -> Binary:
        self.data += struct.pack(f">{len(words)}I", *words)
        return self

    def floats(self, numbers: list[float]) -> Binary:
        self.data += struct.pack(f">{len(numbers)}f", *numbers)
        return self

    def text(self, text: str) -> Binary:
        self.word(len(text))
        self.data += text.encode() + bytes(-len(text) % 4)
        return self

    def node(self, kind: str, fields: int, children: int | None = None) -> Binary:
        """The head of a node; for a group its children follow its fields."""
        return self.text(kind).word(0 if children is None else 2, fields)

    def many(self, name: str, numbers: list[float], each: int = 1) -> Binary:
        return self.text(name).word(len(numbers) // each).floats(numbers).word(0)

    def one(self, name: str, value: int) -> Binary:
        return self.text(name).word(value, 0)


def binary_patch(b: Binary) -> Binary:
    b.node("Coordinate3", 1).many("point", [x for p in hill() for x in p], 3)
    b.node("NurbsSurface", 4).one("numUControlPoints", 3).one("numVControlPoints", 3)
    return b.many("uKnotVector", [0, 0, 0, 1, 1, 1]).many("vKnotVector", [0, 0, 0, 1, 1, 1])


@good("binary", "the binary encoding: a separator defined and used, a field by name, a node that describes itself", faces=2, closed=False)
def binary() -> bytes:
    b = Binary()
    b.node("Separator", 0, 2).word(2)
    b.text("DEF").text("Wing").node("Separator", 1, 3).text("renderCaching").text("OFF").word(0).word(3)
    b.text("Stranger").word(0, 0x8000 | 1).text("SFVec2f").text("size").text("size").floats([1, 2]).word(0)
    binary_patch(b)
    b.text("USE").text("Wing")
    return b.data


@bad("truncated", "the file ends within a list", exit="2", phrase="truncated inside this entity")
def truncated() -> str:
    text = patch()
    return text[: text.index("1 1 1")] + "1 1 1"


@bad("truncated_later", "the file ends behind a surface", exit="01", phrase="truncated inside this entity")
def truncated_later() -> str:
    return patch()[:-3]


@bad("no_points", "a surface without coordinates", exit="2", phrase="no coordinates before it")
def no_points() -> str:
    return HEADER + SURFACE


@bad("one_of_two", "one surface whose knots do not fit beside a sound one", exit="1", phrase="order of")
def one_of_two() -> str:
    return patch() + group(coordinates(hill()), SURFACE.replace("u" + "KnotVector [ 0 0 0 1 1 1 ]", "uKnotVector [ 0 ]"))


@bad("decreasing_knots", "knots that decrease are replaced", exit="01", phrase="uniform knots used")
def decreasing_knots() -> str:
    return patch().replace("vKnotVector [ 0 0 0 1 1 1 ]", "vKnotVector [ 0 0 1 0 1 1 ]")


@bad("open_profile", "a trim that does not close is closed", exit="01", phrase="closed with straight lines")
def open_profile() -> str:
    trim = "  ProfileCoordinate2 { point [ 0.1 0.1, 0.9 0.1, 0.9 0.9 ] }\n  LinearProfile { index [ 0 1 2 ] }\n"
    return HEADER + group(coordinates(hill()), trim, SURFACE)


@good("far_profile", "a trim that leaves its surface ends where the surface does", faces=1, closed=False)
def far_profile() -> str:
    trim = "  ProfileCoordinate2 { point [ 0.1 0.1, 1.9 0.1, 0.9 0.9 ] }\n  LinearProfile { index [ 0 1 2 0 ] }\n"
    return HEADER + group(coordinates(hill()), trim, SURFACE)


@bad("zero_weight", "a control point of weight zero", exit="2", phrase="control point")
def zero_weight() -> str:
    return HEADER + group(coordinates([(*p, 0.0 if k == 4 else 1.0) for k, p in enumerate(hill())], 4), SURFACE)


@bad("use_of_nothing", "a name that nobody has", exit="01", phrase="node Nobody is not defined")
def use_of_nothing() -> str:
    return patch() + "USE Nobody\n"


@bad("itself", "a group that uses itself", exit="01", phrase="used inside itself")
def itself() -> str:
    return HEADER + "DEF A " + group(coordinates(hill()), SURFACE, "USE A\n")


@bad("bomb", "uses of uses, four to the power of forty", exit="01", phrase="too many references")
def bomb() -> str:
    text = HEADER + "DEF N0 " + group(coordinates(hill()), SURFACE)
    return text + "".join(f"DEF N{i} " + group(*[f"USE N{i - 1}\n"] * 4) for i in range(1, 41))


@bad("deep", "groups within groups, a thousand deep", exit="2", phrase="is recursive or nested")
def deep() -> str:
    return HEADER + "Group { " * 1000 + "Cube { }" + " }" * 1000


@bad("nothing", "nodes without a shape", exit="2", phrase="no shape in 2 entities")
def nothing() -> str:
    return HEADER + group("Material { diffuseColor 1 0 0 }\n")


@bad("binary_stranger", "a binary file with a node that nobody knows: what came before stays", exit="01", phrase="the rest of the file is ignored")
def binary_stranger() -> bytes:
    b = Binary()
    b.node("Separator", 0, 3).word(3)
    binary_patch(b)
    b.node("Stranger", 1).text("size").floats([1, 2]).word(0)
    return b.data


@bad("binary_lengths", "a binary file with a list longer than the file", exit="2", phrase="truncated inside this entity")
def binary_lengths() -> bytes:
    return Binary().node("Coordinate3", 1).text("point").word(0x3FFFFFFF).floats([1, 2, 3]).data


if __name__ == "__main__":
    write_all(corpus_folder(__doc__), "iv", ".iv", GOOD, BAD)
