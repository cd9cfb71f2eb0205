"""The VRML97 and X3D files of the corpus, and broken ones: one function each. All are called .x3d; what they
hold tells the encoding.

    python corpus/make/x3d_files.py        # writes corpus/x3d and corpus/x3d/bad with their INDEX.tsv
"""

from __future__ import annotations

import math

from written import BAD, GOOD, bad, corpus_folder, good, write_all

VRML = "#VRML V2.0 utf8\n\n"
CLASSIC = "#X3D V3.3 utf8\nPROFILE Interchange\nCOMPONENT NURBS : 4\n\n"
W = math.sqrt(0.5)
HILL = "0 0 0, 1 0 0, 2 0 0, 0 1 0, 1 1 1, 2 1 0, 0 2 0, 1 2 0, 2 2 0"
RING = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
WEIGHTS = [1 if i % 2 == 0 else W for i in range(9)]
RING_KNOTS = "0 0 0 1 1 2 2 3 3 4 4 4"


def xml(body: str) -> str:
    head = "<?xml version='1.0' encoding='UTF-8'?>\n<X3D profile='Full' version='3.3'>\n"
    return f"{head}<head><meta name='title' content='corpus'/></head>\n<Scene>\n{body}\n</Scene>\n</X3D>\n"


def numbers(points: list[tuple[float, ...]]) -> str:
    return ", ".join(" ".join(f"{x:.9g}" for x in p) for p in points)


def patch_node(more: str = "", kind: str = "NurbsPatchSurface") -> str:
    return f"{kind} {{ uDimension 3 vDimension 3 controlPoint Coordinate {{ point [ {HILL} ] }} {more} }}"


@good("patch_xml", "a patch without knots, XML encoding", faces=1, closed=False)
def patch_xml() -> str:
    return xml(
        "<Shape><Appearance><Material diffuseColor='0.2 0.4 0.8'/></Appearance>\n"
        "<NurbsPatchSurface uDimension='3' vDimension='3' solid='false'>\n"
        f"<CoordinateDouble containerField='controlPoint' point='{HILL}'/></NurbsPatchSurface></Shape>"
    )


@good("patch_classic", "the same patch, classic encoding", faces=1, closed=False)
def patch_classic() -> str:
    look = "appearance Appearance { material Material { diffuseColor 0.2 0.4 0.8 } }"
    return CLASSIC + f"Shape {{ {look}\n geometry {patch_node('solid FALSE')} }}\n"


@good("patch_vrml", "the same patch, VRML97 with its amendment", faces=1, closed=False)
def patch_vrml() -> str:
    return VRML + f"Shape {{ geometry NurbsSurface {{ uDimension 3 vDimension 3 controlPoint [ {HILL} ] }} }}\n"


def contour(*curves: str) -> str:
    return f"Contour2D {{ children [ {' '.join(curves)} ] }}"


def polyline(points: list[tuple[float, float]]) -> str:
    return f"ContourPolyline2D {{ controlPoint [ {numbers(points)} ] }}"


@good("trimmed", "an outer contour, a circle and a chain of a line and a spline as holes", faces=1, closed=False)
def trimmed() -> str:
    circle = [((0.3 + 0.15 * x) * w, (0.5 + 0.15 * y) * w) for (x, y), w in zip(RING, WEIGHTS)]
    weights = " ".join(f"{w:.9g}" for w in WEIGHTS)
    ring = f"NurbsCurve2D {{ knot [ {RING_KNOTS} ] weight [ {weights} ] controlPoint [ {numbers(circle)} ] }}"
    bow = "NurbsCurve2D { order 4 controlPoint [ 0.85 0.3, 0.85 0.7, 0.6 0.7, 0.6 0.3 ] }"
    outer = polyline([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])
    chain = contour(polyline([(0.6, 0.3), (0.85, 0.3)]), bow)
    contours = f"trimmingContour [ {contour(outer)} {contour(ring)} {chain} ]"
    return CLASSIC + f"Shape {{ geometry {patch_node(contours, 'NurbsTrimmedSurface')} }}\n"


@good("ball", "a rational sphere of one patch: poles at both ends, closed round them", faces=1)
def ball() -> str:
    half = [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1)]
    net, weights = [], []
    for (r, z), v in zip(half, WEIGHTS):
        for (x, y), u in zip(RING, WEIGHTS):
            net.append((x * r * u * v, y * r * u * v, z * u * v))
            weights.append(u * v)
    return xml(
        f"<Shape><NurbsPatchSurface uClosed='true' uDimension='9' vDimension='5' uKnot='{RING_KNOTS}'\n"
        f" vKnot='0 0 0 1 1 2 2 2' weight='{' '.join(f'{w:.17g}' for w in weights)}'>\n"
        f"<CoordinateDouble containerField='controlPoint' point='{', '.join(' '.join(f'{x:.17g}' for x in p) for p in net)}'/>"
        "</NurbsPatchSurface></Shape>"
    )


@good("ring", "closed both ways without knots: a periodic torus", faces=1)
def ring() -> str:
    net = []
    for j in range(7):
        for i in range(7):
            a, b = math.tau * (i % 6) / 6, math.tau * (j % 6) / 6
            r = 3 + math.cos(a)
            net.append((r * math.cos(b), math.sin(a), r * math.sin(b)))
    return CLASSIC + (
        "Shape { geometry NurbsPatchSurface { uClosed TRUE vClosed TRUE uDimension 7 vDimension 7 uOrder 4 vOrder 4\n"
        f" controlPoint CoordinateDouble {{ point [ {numbers(net)} ] }} }} }}\n"
    )


@good("thin_tube", "a bent periodic tube a hundred times as long as thick: it turns faster than it strays", faces=1,
      closed=False)
def thin_tube() -> str:
    net = []
    for j in range(6):
        a = math.tau * (j % 5) / 5
        net += [(i / 6, 0.1 * (i in (1, 2)) + 0.006 * math.cos(a), 0.006 * math.sin(a)) for i in range(4)]
    return CLASSIC + (
        "Shape { geometry NurbsPatchSurface { vClosed TRUE uDimension 4 vDimension 6 uOrder 4 vOrder 4\n"
        f" controlPoint CoordinateDouble {{ point [ {numbers(net)} ] }} }} }}\n"
    )


@good("whisker", "a bent closed tube thinner than the tolerance that the rest of the scene asks for", faces=2, closed=False)
def whisker() -> str:
    net = []
    for j in range(7):
        a = math.tau * (j % 4) / 4
        across = (0.005 * math.cos(a), 0.005 * math.sin(a))
        net += [(0.17 * i + across[0], (0, 0.07, 0.24, 0.06)[i] + across[1], -0.01 * i) for i in range(4)]
    tube = (
        "NurbsPatchSurface { solid FALSE uOrder 4 vOrder 4 uDimension 4 vDimension 7 uKnot [ 0 0 0 0 1 1 1 1 ]\n"
        f" vKnot [ -2 -2 -1 0 1 2 3 4 5 6 6 ] controlPoint CoordinateDouble {{ point [ {numbers(net)} ] }} }}"
    )
    return CLASSIC + (
        f"Shape {{ geometry {tube} }}\n"
        f"Transform {{ translation 0 0 -4 scale 4 4 4 children Shape {{ geometry {patch_node('solid FALSE')} }} }}\n"
    )


@good("box_of_one_surface", "a box whose sides and corners are doubled control points of one surface", faces=1, closed=True)
def box_of_one_surface() -> str:
    square = [(0, 1), (1, 1), (1, 1), (1, 0), (1, -1), (1, -1), (0, -1), (-1, -1), (-1, -1), (-1, 0), (-1, 1), (-1, 1), (0, 1)]
    rows = [(0, 1), (0.5, 1), (1, 1), (1, 1), (1, 0), (1, -1), (1, -1), (0.5, -1), (0, -1)]
    net = [(r * x, r * y, z) for r, z in rows for x, y in square]
    return CLASSIC + (
        "Transform { rotation -0.81 -0.557 0.181 0.769 children Shape { geometry NurbsPatchSurface {\n"
        " uClosed TRUE vClosed TRUE uOrder 3 vOrder 3 uDimension 13 vDimension 9\n"
        " uKnot [ 0 0 0 1 2 3 4 5 6 7 8 9 10 11 11 11 ] vKnot [ 0 0 0 1 2 3 4 5 6 7 7 7 ]\n"
        f" controlPoint Coordinate {{ point [ {numbers(net)} ] }} }} }} }}\n"
    )


@good("swept", "a spline swept along a line, and a profile swung round a circle", faces=2, closed=False)
def swept() -> str:
    arc = f"weight [ 1 {W:.9g} 1 ]"
    return CLASSIC + (
        "Shape { geometry NurbsSweptSurface { crossSectionCurve NurbsCurve2D { controlPoint [ 1 0, 1 1, 0 1 ] }\n"
        " trajectoryCurve NurbsCurve { order 2 controlPoint Coordinate { point [ 0 0 0, 0 3 1 ] } } } }\n"
        "Transform { translation 5 0 0 children Shape { geometry NurbsSwungSurface {\n"
        f" profileCurve NurbsCurve2D {{ controlPoint [ 0 3, 1 2, 2 3 ] }}\n"
        f" trajectoryCurve NurbsCurve2D {{ controlPoint [ 1 0, {W:.9g} {W:.9g}, 0 1 ] {arc} }} }} }} }}\n"
    )


@good("prototype", "a prototype with a colour and points of its own, used twice", faces=2, closed=False)
def prototype() -> str:
    return VRML + (
        "PROTO Tile [ field SFColor paint 1 1 1 field MFVec3f points [] ] { Shape {\n"
        " appearance Appearance { material Material { diffuseColor IS paint } }\n"
        " geometry NurbsSurface { uDimension 3 vDimension 3 controlPoint IS points } } }\n"
        f"Tile {{ paint 1 0 0 points [ {HILL} ] }}\n"
        f"Transform {{ translation 3 0 0 children Tile {{ points [ {HILL} ] }} }}\n"
    )


@good("instances", "one shape in four places, one of them skewed, in inches and degrees", faces=4, closed=False)
def instances() -> str:
    return xml(
        "<Group><Shape DEF='Tile'><NurbsPatchSurface uDimension='3' vDimension='3'>"
        f"<Coordinate containerField='controlPoint' point='{HILL}'/></NurbsPatchSurface></Shape>\n"
        "<Transform translation='4 0 0' rotation='0 0 1 90'><Shape USE='Tile'/></Transform>\n"
        "<Transform translation='0 4 0' scale='1 -2 1'><Shape USE='Tile'/></Transform>\n"
        "<Switch whichChoice='0'><Transform translation='4 4 0' scale='1 2 3' scaleOrientation='1 1 0 30'>"
        "<Shape USE='Tile'/></Transform></Switch></Group>"
    ).replace("<head>", "<head><unit category='length' name='inch' conversionFactor='0.0254'/>"
              "<unit category='angle' name='degree' conversionFactor='0.017453292519943295'/>")


@good("solids", "a box, a sphere, a cylinder and a cone", faces=12, solids=4)
def solids() -> str:
    kinds = ["Box { size 1 2 3 }", "Sphere { }", "Cylinder { height 1 }", "Cone { }"]
    place = "Transform {{ translation {0} 0 0 children Shape {{ geometry {1} }} }}\n"
    return VRML + "".join(place.format(3 * i, kind) for i, kind in enumerate(kinds))


@good("polygons", "polygons of seven kinds and no surface", faces=0, closed=False)
def polygons() -> str:
    points = "coord Coordinate { point [ 0 0 0, 2 0 0, 2 2 0, 1 0.5 0 ] }"
    kinds = ["IndexedFaceSet { coordIndex [ 0 1 2 3 -1 ]", "IndexedTriangleSet { index [ 0 1 3 1 2 3 ]", "QuadSet {",
             "TriangleStripSet { stripCount 4", "IndexedTriangleStripSet { index [ 0 1 3 2 -1 ]",
             "TriangleFanSet { fanCount [ 4 ] ccw FALSE"]
    shapes = "".join(f"Shape {{ geometry {kind} {points} }} }}\n" for kind in kinds)
    return CLASSIC + shapes + "Shape { geometry ElevationGrid { xDimension 2 zDimension 2 height [ 0 0 0 1 ] } }\n"


@bad("truncated_xml", "the file ends within an element", exit="01", phrase="the file is truncated")
def truncated_xml() -> str:
    return patch_xml().split("</Scene>")[0]


@bad("broken_xml", "no XML behind the first shape", exit="01", phrase="syntax error")
def broken_xml() -> str:
    return patch_xml().split("</Scene>")[0] + "<Group DEF='"


@bad("few_points", "fewer points than the net needs", exit="2", phrase="number of control points is 8, at least 9")
def few_points() -> str:
    return patch_classic().replace(", 2 2 0", "")


@bad("bad_weights", "weights that are too few are left out", exit="01", phrase="2 weights for 9 control points")
def bad_weights() -> str:
    return patch_classic().replace("solid FALSE", "weight [ 1 2 ]")


@bad("bent_sweep", "a sweep along a bent line has no exact form", exit="2", phrase="trajectory is bent")
def bent_sweep() -> str:
    return swept().split("Transform")[0].replace("0 3 1", "0 3 1, 1 4 1")


@bad("script", "a prototype whose points a script would compute", exit="2", phrase="number of control points is 0")
def script() -> str:
    return CLASSIC + (
        "PROTO Made [ ] { NurbsPatchSurface { uDimension 3 vDimension 3 controlPoint DEF P Coordinate { } }\n"
        ' Script { url "ecmascript: function initialize() {}" } }\nShape { geometry Made { } }\n'
    )


@bad("inline", "another file is not followed", exit="01", phrase="which is not read")
def inline() -> str:
    return patch_classic() + 'Inline { url "other.x3dv" }\n'


@bad("bomb", "uses of uses, four to the power of forty", exit="01", phrase="too many references")
def bomb() -> str:
    text = VRML + "DEF N0 Shape { geometry Box { } }\n"
    return text + "".join(f"DEF N{i} Group {{ children [ {f'USE N{i - 1} ' * 4}] }}\n" for i in range(1, 41))


@bad("prototype_bomb", "prototypes of prototypes, four to the power of forty", exit="012", phrase="")
def prototype_bomb() -> str:
    text = VRML + "PROTO P0 [ ] { Shape { geometry Box { } } }\n"
    for i in range(1, 41):
        text += f"PROTO P{i} [ ] {{ Group {{ children [ {f'P{i - 1} {{ }} ' * 4}] }} }}\n"
    return text + "P40 { }\n"


@bad("deep", "elements within elements, a thousand deep", exit="2", phrase="is recursive or nested")
def deep() -> str:
    return xml("<Group>" * 1000 + "<Shape><Box/></Shape>" + "</Group>" * 1000)


@bad("nothing", "a scene without a shape", exit="2", phrase="no shape in 1 entities")
def nothing() -> str:
    return xml("<Viewpoint/>")


if __name__ == "__main__":
    write_all(corpus_folder(__doc__), "x3d", ".x3d", GOOD, BAD)
