"""The surfaces of scene, OBJ, JSON and 3DM files, read anew and given to another kernel.

Small readers of their own, no code of Chordal's: what they give are surfaces and curves of OpenCASCADE made
of the file's numbers, and which parameters the trims keep. 3DM archives go through rhino3dm, which tells
surfaces and edges but no trims.
"""

from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from OCP.Geom import Geom_BSplineSurface
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.gp import gp_Pnt, gp_Pnt2d
from OCP.TColgp import TColgp_Array1OfPnt2d, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal


class Unreadable(Exception):
    """What these small readers do not know."""


@dataclass
class Curve:
    """A curve of parameter space: points are (u, v, weight), not multiplied by the weight."""

    degree: int
    knots: list[float]
    points: list[tuple[float, float, float]]


@dataclass
class Patch:
    """A surface: `net[i][j]` is (x, y, z, weight) at row i of u, not multiplied by the weight."""

    degree: tuple[int, int]
    knots: tuple[list[float], list[float]]
    net: np.ndarray
    outer: list[list[Curve]] = field(default_factory=list)
    holes: list[list[Curve]] = field(default_factory=list)

    def moved(self, matrix: np.ndarray) -> Patch:
        net = self.net.copy()
        net[..., :3] = net[..., :3] @ matrix[:3, :3].T + matrix[:3, 3]
        return Patch(self.degree, self.knots, net, self.outer, self.holes)


def multiplicities(knots: list[float]) -> tuple[list[float], list[int]]:
    values: list[float] = []
    counts: list[int] = []
    for knot in knots:
        if values and knot == values[-1]:
            counts[-1] += 1
        else:
            values.append(knot)
            counts.append(1)
    return values, counts


def knot_arrays(knots: list[float], degree: int):
    values, counts = multiplicities(knots)
    counts = [min(c, degree + 1) if i in (0, len(counts) - 1) else c for i, c in enumerate(counts)]
    reals, integers = TColStd_Array1OfReal(1, len(values)), TColStd_Array1OfInteger(1, len(values))
    for i, (value, count) in enumerate(zip(values, counts), 1):
        reals.SetValue(i, float(value))
        integers.SetValue(i, count)
    return reals, integers


def surface(patch: Patch) -> Geom_BSplineSurface:
    rows, columns = patch.net.shape[:2]
    points, weights = TColgp_Array2OfPnt(1, rows, 1, columns), TColStd_Array2OfReal(1, rows, 1, columns)
    for i in range(rows):
        for j in range(columns):
            x, y, z, w = map(float, patch.net[i, j])
            points.SetValue(i + 1, j + 1, gp_Pnt(x, y, z))
            weights.SetValue(i + 1, j + 1, w)
    (ku, mu), (kv, mv) = (knot_arrays(k, d) for k, d in zip(patch.knots, patch.degree))
    return Geom_BSplineSurface(points, weights, ku, kv, mu, mv, *patch.degree)


def curve(c: Curve) -> Geom2d_BSplineCurve:
    points, weights = TColgp_Array1OfPnt2d(1, len(c.points)), TColStd_Array1OfReal(1, len(c.points))
    for i, (u, v, w) in enumerate(c.points, 1):
        points.SetValue(i, gp_Pnt2d(u, v))
        weights.SetValue(i, w)
    return Geom2d_BSplineCurve(points, weights, *knot_arrays(c.knots, c.degree), c.degree)


def sampled(loop: list[Curve], steps: int = 3000) -> np.ndarray:
    """Points along a loop of parameter space, closed."""
    points = []
    for c in loop:
        made = curve(c)
        breaks = sorted(
            {
                made.FirstParameter(),
                made.LastParameter(),
                *(k for k in c.knots if made.FirstParameter() < k < made.LastParameter()),
            }
        )
        each = max(8, steps // (len(loop) * (len(breaks) - 1)))
        for low, high in zip(breaks, breaks[1:]):
            points += [made.Value(low + (high - low) * k / each) for k in range(each + 1)]
    found = np.array([[p.X(), p.Y()] for p in points + points[:1]])
    if np.linalg.norm(found[-1] - found[-2]) > 1e-3 * np.linalg.norm(np.ptp(found, axis=0)):
        raise Unreadable("a trim that does not close")
    return found


def inside(patch: Patch, loops: tuple[list[np.ndarray], list[np.ndarray]], uv: np.ndarray) -> np.ndarray:
    """Which parameters belong to the face: within an outer loop, where there is one, and within no hole."""
    outer, holes = loops
    kept = np.ones(len(uv), bool)
    if outer:
        kept = np.logical_or.reduce([within(loop, uv) for loop in outer])
    for loop in holes:
        kept &= ~within(loop, uv)
    return kept


def within(loop: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """By the number of crossings of a ray."""
    found = np.zeros(len(uv), bool)
    a, b = loop[:-1], loop[1:]
    for i in range(0, len(uv), 2000):
        x, y = uv[i : i + 2000, :1], uv[i : i + 2000, 1:]
        crosses = (a[:, 1] > y) != (b[:, 1] > y)
        with np.errstate(all="ignore"):
            at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        found[i : i + 2000] = (crosses & (x < at)).sum(1) % 2 == 1
    return found


def bezier_knots(parameters: list[float], degree: int) -> list[float]:
    inner = [p for p in parameters[1:-1] for _ in range(degree)]
    return [parameters[0]] * (degree + 1) + inner + [parameters[-1]] * (degree + 1)


# --- geomdl
# -------------------------------------------------------------------------------------------------------------


def geomdl(path: Path) -> list[Patch]:
    data = json.loads(path.read_text())["shape"]["data"]
    patches = []
    for item in data if isinstance(data, list) else [data]:
        points = np.array(item["control_points"]["points"], float)
        weights = np.array(item["control_points"].get("weights") or np.ones(len(points)), float)
        net = np.c_[points[:, :3], weights].reshape(item["size_u"], item["size_v"], 4)
        patch = Patch((item["degree_u"], item["degree_v"]), (item["knotvector_u"], item["knotvector_v"]), net)
        trims = item.get("trims") or {}
        for trim in trims.get("data", []) if isinstance(trims, dict) else trims:
            loop = geomdl_loop(trim)
            (patch.outer if trim.get("reversed", 0) else patch.holes).append(loop)
        patches.append(patch)
    return patches


def geomdl_loop(trim: dict) -> list[Curve]:
    if trim.get("type") == "freeform":
        points = (
            [tuple(p[:2]) for p in trim["points"]]
            if "points" in trim
            else [tuple(p[:2]) for p in trim["data"]]
        )
        if points[0] != points[-1]:
            points.append(points[0])
        return [
            Curve(1, [0.0, 0.0, 1.0, 1.0], [(*a, 1.0), (*b, 1.0)])
            for a, b in zip(points, points[1:])
            if a != b
        ]
    if trim.get("type") == "container" or "control_points" not in trim:
        return chained([c for part in trim["data"] for c in geomdl_loop(part)])
    points = trim["control_points"]["points"]
    weights = trim["control_points"].get("weights") or [1.0] * len(points)
    return [Curve(trim["degree"], trim["knotvector"], [(p[0], p[1], w) for p, w in zip(points, weights)])]


def chained(pieces: list[Curve]) -> list[Curve]:
    """The pieces in the order and direction in which their ends meet."""
    rest, chain = pieces[1:], pieces[:1]
    while rest:
        end = np.array(chain[-1].points[-1][:2])
        away = [
            (np.linalg.norm(np.array(c.points[k][:2]) - end), i, k)
            for i, c in enumerate(rest)
            for k in (0, -1)
        ]
        _, i, k = min(away)
        c = rest.pop(i)
        top = c.knots[0] + c.knots[-1]
        chain.append(c if k == 0 else Curve(c.degree, [top - x for x in reversed(c.knots)], c.points[::-1]))
    return chain


# --- OBJ
# ----------------------------------------------------------------------------------------------------------------


CARDINAL = np.array([[0, 1, 0, 0], [-1 / 6, 1, 1 / 6, 0], [0, 1 / 6, 1, -1 / 6], [0, 0, 1, 0]])
TAYLOR = np.array([[1, 0, 0, 0], [1, 1 / 3, 0, 0], [1, 2 / 3, 1 / 3, 0], [1, 1, 1, 1]])


def obj(path: Path) -> list[Patch]:
    places: list[list[float]] = []
    plane: list[list[float]] = []
    patches: list[Patch] = []
    curves: list[Curve] = []
    kind, rational, degree = "", False, [0, 0]
    element: tuple | None = None
    for line in path.read_text().splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        key, *args = words
        if key == "v":
            places.append([float(a) for a in args] + [1.0] * (4 - len(args)))
        elif key == "vp":
            plane.append([float(a) for a in args] + [0.0] * (2 - len(args)) + [1.0] * (len(args) < 3))
        elif key == "cstype":
            rational, kind = args[0] == "rat", args[-1]
        elif key == "deg":
            degree = [int(a) for a in args] * (2 if len(args) == 1 else 1)
        elif key in ("surf", "curv2"):
            element = (key, args, {}, [])
        elif key == "parm" and element:
            element[2][args[0]] = [float(a) for a in args[1:]]
        elif key in ("trim", "hole") and element:
            element[3].append((key, args))
        elif key == "end" and element:
            name, args, parm, trims = element
            element = None
            if name == "curv2":
                index = [int(a) for a in args]
                points = [plane[i - 1] if i > 0 else plane[i] for i in index]
                points = [(p[0], p[1], p[2] if rational and len(p) > 2 else 1.0) for p in points]
                knots = parm.get("u", [0.0, 1.0])
                knots = (
                    bezier_knots(knots, degree[0])
                    if kind == "bezier"
                    else knots[: len(points) + degree[0] + 1]
                )
                curves.append(Curve(degree[0], knots, points))
                continue
            patches.append(obj_patch(places, args, parm, kind, rational, degree))
            for role, pieces in trims:
                loop = [curves[int(i) - 1 if int(i) > 0 else int(i)] for i in pieces[2::3]]
                (patches[-1].outer if role == "trim" else patches[-1].holes).append(loop)
    return patches


def obj_patch(places, args, parm, kind, rational, degree) -> Patch:
    index = [int(a.split("/")[0]) for a in args[4:]]
    points = np.array([places[i - 1] if i > 0 else places[i] for i in index])
    if not rational:
        points[:, 3] = 1.0
    ku, kv = parm["u"], parm["v"]
    if kind == "bspline":
        columns = len(ku) - degree[0] - 1
        net = points.reshape(-1, columns, 4).transpose(1, 0, 2)
        return Patch(tuple(degree), (ku, kv), net)
    if kind == "bezier":
        columns = degree[0] * (len(ku) - 1) + 1
        net = points.reshape(-1, columns, 4).transpose(1, 0, 2)
        return Patch(tuple(degree), (bezier_knots(ku, degree[0]), bezier_knots(kv, degree[1])), net)
    if kind in ("cardinal", "taylor") and len(points) == 16 and degree == [3, 3]:
        basis = CARDINAL if kind == "cardinal" else TAYLOR
        net = np.einsum("ai,bj,ijk->abk", basis, basis, points.reshape(4, 4, 4).transpose(1, 0, 2))
        net[..., 3] = 1.0
        return Patch((3, 3), (bezier_knots(ku, 3), bezier_knots(kv, 3)), net)
    raise Unreadable(f"cstype {kind}")


# --- Inventor, VRML, X3D
# ------------------------------------------------------------------------------------------------


class Node(dict):
    """Fields by name; `kind` is the type, `children` what stands in it in order."""

    kind = ""


def scene(path: Path) -> list[Patch]:
    raw = path.read_bytes()
    if raw.lstrip()[:1] == b"<":
        roots = [xml_node(e) for e in ElementTree.fromstring(raw).iter("Scene")]
    else:
        text = raw.decode("utf8", "replace")
        if "binary" in text.splitlines()[0]:
            raise Unreadable("binary")
        if re.search(r"^\s*(EXTERN)?PROTO\b", text, re.M):
            raise Unreadable("prototypes")
        text = re.sub(r'"(\\.|[^"\\])*"', '""', text)
        text = re.sub(r"#.*", "", text)
        tokens = re.findall(r'[{}\[\]]|""|[^\s,{}\[\]]+', text)
        roots = Parser(tokens).nodes()
    found: list[Patch] = []
    # Lengths are metres.
    walk(roots, np.diag([1000.0, 1000.0, 1000.0, 1.0]), {}, found)
    return found


class Parser:
    """The common syntax of Inventor and VRML: `Name { field value … }`, `DEF`, `USE`."""

    def __init__(self, tokens: list[str]):
        self.tokens, self.at, self.named = tokens, 0, {}

    def peek(self, ahead: int = 0) -> str:
        return self.tokens[self.at + ahead] if self.at + ahead < len(self.tokens) else ""

    def next(self) -> str:
        self.at += 1
        return self.tokens[self.at - 1]

    def starts_node(self) -> bool:
        return self.peek() in ("DEF", "USE") or (self.peek(1) == "{" and self.peek()[:1].isalpha())

    def nodes(self) -> list[Node]:
        found = []
        while self.at < len(self.tokens):
            if self.starts_node():
                found.append(self.node())
            elif self.peek() in ("}", "]"):
                break
            else:
                self.next()
        return found

    def node(self) -> Node:
        name = None
        if self.peek() == "USE":
            self.next()
            return self.named.get(self.next(), Node())
        if self.peek() == "DEF":
            self.next()
            name = self.next()
        node = Node()
        node.kind, node.children = self.next(), []
        self.next()
        while self.peek() not in ("}", ""):
            if self.starts_node():
                node.children.append(self.node())
                continue
            key, values = self.next(), []
            if self.peek() == "[":
                self.next()
                while self.peek() not in ("]", ""):
                    values.append(self.node() if self.starts_node() else self.next())
                self.next()
            elif self.starts_node():
                values.append(self.node())
            else:
                while (
                    self.peek() not in ("}", "")
                    and not self.starts_node()
                    and (not values or not self.peek()[:1].isalpha())
                ):
                    values.append(self.next())
            node[key] = values
        self.next()
        if name:
            self.named[name] = node
        return node


def xml_node(element: ElementTree.Element) -> Node:
    node = Node()
    node.kind, node.children = element.tag, []
    for key, value in element.attrib.items():
        node[key] = re.split(r"[\s,]+", value.strip())
    for child in element:
        made = xml_node(child)
        slot = child.attrib.get("containerField")
        node.setdefault(slot, []).append(made) if slot else node.children.append(made)
    return node


def numbers(node: Node, key: str, default=None) -> list[float]:
    return [float(v) for v in node[key]] if key in node else list(default or [])


def placement(node: Node) -> np.ndarray:
    def shift(v):
        m = np.eye(4)
        m[:3, 3] = v
        return m

    def turn(v):
        x, y, z, angle = v
        axis = np.array([x, y, z]) / (math.hypot(x, y, z) or 1.0)
        k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        m = np.eye(4)
        m[:3, :3] += math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
        return m

    center, tilt = numbers(node, "center", [0, 0, 0]), numbers(node, "scaleOrientation", [0, 0, 1, 0])
    scale = np.diag([*numbers(node, "scale" if "scale" in node else "scaleFactor", [1, 1, 1]), 1.0])
    around = turn(tilt) @ scale @ np.linalg.inv(turn(tilt))
    return (
        shift(numbers(node, "translation", [0, 0, 0]))
        @ shift(center)
        @ turn(numbers(node, "rotation", [0, 0, 1, 0]))
        @ around
        @ shift([-c for c in center])
    )


def walk(nodes: list, matrix: np.ndarray, state: dict, found: list[Patch]) -> None:
    for node in nodes:
        if not isinstance(node, Node):
            continue
        if (
            node.kind in ("NurbsPatchSurface", "NurbsTrimmedSurface")
            or node.kind == "NurbsSurface"
            and "uDimension" in node
        ):
            found.append(patch_of(node).moved(matrix))
        elif node.kind == "NurbsSurface":
            found.append(inventor_patch(node, state).moved(matrix))
        elif node.kind in ("Coordinate3", "Coordinate4"):
            state["points"] = np.array(numbers(node, "point")).reshape(-1, int(node.kind[-1]))
        elif node.kind in ("ProfileCoordinate2", "ProfileCoordinate3"):
            state["profile"] = np.array(numbers(node, "point")).reshape(-1, int(node.kind[-1]))
        elif node.kind in ("NurbsProfile", "LinearProfile"):
            inventor_profile(node, state)
        else:
            inner = matrix @ placement(node) if node.kind == "Transform" else matrix
            if node.kind == "Transform" and not node.children and "children" not in node:
                matrix = inner
            own = [v for key, values in node.items() if isinstance(values, list) for v in values]
            walk(node.children + own, inner, dict(state), found)


def control_points(node: Node) -> np.ndarray:
    inner = [v for v in [*node.get("controlPoint", []), *node.children] if isinstance(v, Node)]
    values = numbers(inner[0], "point") if inner else numbers(node, "controlPoint")
    return np.array(values)


def patch_of(node: Node) -> Patch:
    size = [int(node[k][0]) for k in ("uDimension", "vDimension")]
    order = [int(node.get(k, ["3"])[0]) for k in ("uOrder", "vOrder")]
    points = control_points(node).reshape(-1, 3)
    weights = numbers(node, "weight")
    weights = np.array(weights if len(weights) == len(points) else [1.0] * len(points))
    net = np.c_[points, weights].reshape(size[1], size[0], 4).transpose(1, 0, 2)
    # Since the amendment of 1997 control points are multiplied by their weights.
    net[..., :3] /= net[..., 3:]
    knots = [numbers(node, k) for k in ("uKnot", "vKnot")]
    for axis in range(2):
        if len(knots[axis]) != size[axis] + order[axis]:
            raise Unreadable("knots are left to the reader")
    patch = Patch((order[0] - 1, order[1] - 1), tuple(knots), net)
    contours = [v for v in [*node.get("trimmingContour", []), *node.children] if isinstance(v, Node)]
    for contour in (c for c in contours if c.kind == "Contour2D"):
        loop = [
            contour_curve(c) for c in [*contour.get("children", []), *contour.children] if isinstance(c, Node)
        ]
        (patch.holes if patch.outer else patch.outer).append(loop)
    return patch


def contour_curve(node: Node) -> Curve:
    points = control_points(node).reshape(-1, 2)
    if node.kind != "NurbsCurve2D":
        knots = [0.0, *map(float, range(len(points))), float(len(points) - 1)]
        return Curve(1, knots, [(*p, 1.0) for p in points])
    weights = numbers(node, "weight") or [1.0] * len(points)
    order = int(node.get("order", ["3"])[0])
    # As in the amendment of 1997, points are multiplied by their weights.
    return Curve(order - 1, numbers(node, "knot"), [(*(p / w), w) for p, w in zip(points, weights)])


def inventor_patch(node: Node, state: dict) -> Patch:
    size = [int(node[k][0]) for k in ("numUControlPoints", "numVControlPoints")]
    knots = [numbers(node, k) for k in ("uKnotVector", "vKnotVector")]
    points = state["points"]
    points = (
        np.c_[points, np.ones(len(points))]
        if points.shape[1] == 3
        else np.c_[points[:, :3] / points[:, 3:], points[:, 3:]]
    )
    net = points[: size[0] * size[1]].reshape(size[1], size[0], 4).transpose(1, 0, 2)
    patch = Patch(tuple(len(k) - n - 1 for k, n in zip(knots, size)), tuple(knots), net)
    loops = state.get("loops", [])
    patch.outer, patch.holes = loops[:1], loops[1:]
    return patch


def inventor_profile(node: Node, state: dict) -> None:
    points = state["profile"]
    points = np.c_[points, np.ones(len(points))] if points.shape[1] == 2 else points
    points = points[[int(float(i)) for i in node["index"]]] if "index" in node else points
    if node.kind == "LinearProfile":
        knots = [0.0, *map(float, range(len(points))), float(len(points) - 1)]
    else:
        knots = numbers(node, "knotVector")
    made = Curve(len(knots) - len(points) - 1, knots, [tuple(p) for p in points])
    loops = state.setdefault("loops", [])
    if node.get("linkage", ["START_FIRST"])[0] == "ADD_TO_CURRENT" and loops:
        loops[-1].append(made)
    else:
        loops.append([made])


# --- 3DM
# ----------------------------------------------------------------------------------------------------------------


def rhino(path: Path) -> tuple[list[Patch], list[np.ndarray]]:
    """The whole surfaces of all faces, and points along all edges, in millimetres."""
    import rhino3dm

    archive = rhino3dm.File3dm.Read(str(path))
    unit = {
        "Millimeters": 1.0,
        "None": 1.0,
        "Centimeters": 10.0,
        "Meters": 1000.0,
        "Inches": 25.4,
        "Feet": 304.8,
    }
    scale = unit[str(archive.Settings.ModelUnitSystem).split(".")[-1]]
    patches, edges = [], []
    for thing in archive.Objects:
        body = thing.Geometry
        if isinstance(body, (rhino3dm.Extrusion, rhino3dm.Surface)) and not isinstance(body, rhino3dm.Brep):
            body = rhino3dm.Brep.TryConvertBrep(body) if isinstance(body, rhino3dm.Extrusion) else body
        if not isinstance(body, rhino3dm.Brep):
            continue
        for face in body.Faces:
            nurbs = face.UnderlyingSurface().ToNurbsSurface()
            rows, columns = nurbs.Points.CountU, nurbs.Points.CountV
            net = np.array(
                [
                    [[p.X, p.Y, p.Z, p.W] for p in (nurbs.Points[i, j] for j in range(columns))]
                    for i in range(rows)
                ]
            )
            net[..., :3] *= scale / net[..., 3:]
            ku, kv = list(nurbs.KnotsU), list(nurbs.KnotsV)
            full = ([ku[0], *ku, ku[-1]], [kv[0], *kv, kv[-1]])
            patches.append(Patch((nurbs.Degree(0), nurbs.Degree(1)), full, net))
        for edge in body.Edges:
            domain = edge.Domain
            at = np.linspace(domain.T0, domain.T1, 65)
            edges.append(scale * np.array([[p.X, p.Y, p.Z] for p in map(edge.PointAt, at)]))
    return patches, edges


READERS = {"json": geomdl, "obj": obj, "iv": scene, "x3d": scene}
